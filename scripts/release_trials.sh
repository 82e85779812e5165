# Sourced by release.sh: what was made, tried on the bare system that it is for. Each trial begins with a Debian that has its
# base system alone.
source scripts/container.sh

# bare RELEASE: sets $root to such a Debian, new. It is made once, and copied.
bare() {
  local made=$trials/debian$1 why
  if [[ ! -e $made/etc/debian_version ]]; then
    why=$(make_bare_debian "${debian_suites[$1]}" "$made")
    [[ -z $why ]] || die "no bare Debian $1 can be made here: $why"
    root=$made
    quietly "apt-get update in the bare Debian $1" inside 'apt-get -qq update'
  fi
  root=$trials/root
  rm -rf --one-file-system "$root"
  cp -a "$made" "$root"
}

no_compiler() { inside '! command -v cc && ! command -v gcc && ! command -v g++' >/dev/null || die "a compiler was installed"; }

# try_wheel RELEASE: pip installs it without a network, it draws by every SIMD target of this CPU, and reads EXR once
# OpenImageIO is there.
try_wheel() {
  bare "$1"
  cp "$out"/*.whl scripts/try_wheel.py "$root/root/"
  quietly "python3-venv in Debian $1" inside 'apt-get -qq -y --no-install-recommends install python3-venv python3-numpy'
  SECONDS=0
  quietly "pip install of the wheel on Debian $1" inside \
    'cd /root && python3 -m venv --system-site-packages venv && venv/bin/pip install -q --no-index ./*.whl'
  local took=$SECONDS targets
  targets=$(inside "cd /root && venv/bin/python try_wheel.py $golden without") || die "the wheel fails on Debian $1"
  quietly "OpenImageIO in Debian $1" inside 'apt-get -qq -y --no-install-recommends install "^libopenimageio2\.[0-9]+(t64)?$"'
  inside "cd /root && venv/bin/python try_wheel.py $golden with" >/dev/null || die "the wheel does not read EXR on Debian $1"
  no_compiler
  tried "the wheel on a bare Debian $1, Python $(inside 'python3 -c "import platform; print(platform.python_version())"'): installed in $took s, $targets with the golden hash; reads EXR once OpenImageIO is there"
}

# try_sources: what the archive holds is set up and drawn by ./run, as by a new user.
try_sources() {
  bare 12
  tar -C "$root/root" -xf "$out/trueshade-$version.tar.xz"
  SECONDS=0
  quietly "./run of the source archive" inside "cd /root/trueshade-$version && ./run"
  [[ $(inside "cd /root/trueshade-$version && build/release/cli/trueshade render builtin:city --hash") == "sha256:$golden "* ]] ||
    die "the source archive draws builtin:city with another hash"
  tried "the source archive on a bare Debian 12: ./run took $SECONDS s, packages and compiling included; the golden hash"
}

try_container() {
  bare 12
  build_container "$out"
  [[ $(in_container render builtin:city -o city.exr --hash) == "sha256:$golden "* ]] || die "the container draws another hash"
  in_container info city.exr >/dev/null || die "the container does not read EXR"
  quietly "the container's validate" in_container validate builtin:cornell --size 64x48 --driver llvmpipe --quick
  no_compiler
  tried "the Containerfile's steps in a bare Debian 12: the golden hash; EXR is read, llvmpipe judged"
}

# try_action RELEASE: the action's steps, on the files as they would lie on a release's page; a file that was changed on the
# way is refused.
try_action() {
  bare "$1"
  mkdir "$root/root/downloads"
  cp "$out"/SHA256SUMS "$out"/trueshade*_debian"$1"_amd64.deb "$root/root/downloads/"
  /usr/bin/python3 scripts/action.py downloads=file:///root/downloads 'arguments=render builtin:city --hash' >"$root/root/action.sh"
  local shown
  shown=$(inside 'cd /root && bash action.sh 2>&1') || die "the action's steps fail on Debian $1: $shown"
  grep -q "sha256:$golden " <<<"$shown" || die "the action draws another hash"
  printf '\n' >>"$(compgen -G "$root/root/downloads/trueshade_*.deb")"
  if inside 'cd /root && bash action.sh' >/dev/null 2>&1; then die "the action installs a package whose sum is another"; fi
  tried "the steps of action.yml in a bare Debian $1: the golden hash; a package whose sum is another is refused"
}
