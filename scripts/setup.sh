# Sourced by run and check: brings the packages that are missing, and builds. Silent where there is nothing to do.
# Needs bash and coreutils only. Logs are shown where a step fails, and nowhere else.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf 'trueshade: %s\n' "$*"; }
die() {
  printf 'trueshade: error: %s\n' "$*" >&2
  exit 1
}

# quietly WHAT COMMAND...: runs it, and shows what it said if it fails. Lines `left out: ...`, by which cmake says what it
# does not build although its packages are asked for, are shown in any case.
quietly() {
  local what=$1 log status=0
  shift
  log=$(mktemp)
  "$@" >"$log" 2>&1 </dev/null || status=$?
  if ((status != 0)); then
    cat "$log" >&2
    rm -f "$log"
    die "$what failed (its output is above)"
  fi
  sed -n 's/^left out: /trueshade: &/p' "$log"
  rm -f "$log"
}

# copy_checkout FOLDER: this checkout, without what git ignores, into a folder.
copy_checkout() {
  mkdir -p "$1"
  git ls-files -z --cached --others --exclude-standard | tar --ignore-failed-read --null --files-from=- -cf - | tar -C "$1" -xf -
}

# listed_packages picture|command|tests: the list's first part, the first two, or all of it.
listed_packages() {
  local until='^$'  # matches no line that is kept
  [[ $1 == picture ]] && until='^# command:'
  [[ $1 == command ]] && until='^# tests:'
  sed "/$until/,\$d" "$root/scripts/packages.txt" | grep -v '^#'
}

# Names of the packages given that are not installed.
missing_packages() {
  local package status
  for package; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=absent
    [[ $status == installed ]] || printf '%s\n' "$package"
  done
}

# install_packages picture|command|tests [EXTRA...]: what building this much needs, and what else is named.
install_packages() {
  local -a wanted missing as_root=()
  mapfile -t wanted < <(listed_packages "$1"; printf '%s\n' "${@:2}" | grep . || true)
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    [[ -e $root/build/.packages-named ]] && return
    mkdir -p "$root/build" && touch "$root/build/.packages-named"
    say "this is no Debian; going on as if the like of these were installed: ${wanted[*]}"
    return
  fi
  mapfile -t missing < <(missing_packages "${wanted[@]}")
  ((${#missing[@]} == 0)) && return
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      die "packages are missing; as root run: apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  local -a get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y)
  say "installing ${#missing[@]} packages: ${missing[*]}"
  # The lists of a new machine are empty or old: fetched only where the packages cannot be had without.
  if ! "${get[@]}" --no-install-recommends install "${missing[@]}" >/dev/null 2>&1 </dev/null; then
    quietly "apt-get update" "${get[@]}" update
    quietly "apt-get install" "${get[@]}" --no-install-recommends install "${missing[@]}"
  fi
}

# configure PRESET SETTING...: configures build/PRESET where it is new, or where a setting of its cache is another one.
configure() {
  local folder=$root/build/$1 setting same=true
  local -a settings=("${@:2}")
  local -a launcher=()
  for setting in "${settings[@]}"; do
    grep -qE "^${setting%%=*}:[A-Z]+=${setting#*=}$" "$folder/CMakeCache.txt" 2>/dev/null || same=false
  done
  [[ $same == true && -e $folder/build.ninja ]] && return
  say "configuring build/$1"
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  quietly "cmake" cmake -S "$root" --preset "$1" "${launcher[@]}" "${settings[@]/#/-D}"
}

# build PRESET [TARGET...]: builds what has changed, all of it or these targets.
build() {
  local folder=$root/build/$1
  local -a target=()
  (($# > 1)) && target=(--target "${@:2}")
  # Said after two seconds, so that a start with nothing to build says nothing. (A dry run of ninja cannot tell: CMake's
  # check of globbed folders counts as work.)
  { sleep 2 >/dev/null && say "building build/$1 on $(nproc) cores, which takes minutes the first time"; } &
  local teller=$!
  trap "kill $teller 2>/dev/null || true" EXIT
  quietly "the build" cmake --build "$folder" --parallel "$(nproc)" "${target[@]}"
  kill "$teller" 2>/dev/null || true
  trap - EXIT
}
