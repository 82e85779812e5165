#!/bin/bash
# scripts/release.sh, which is ./check release: leaves in out/release what a release offers for downloading, each tried on the
# bare system that it is for (scripts/release_trials.sh), and release.md, the page that goes with it:
#   trueshade*_debian12_amd64.deb, trueshade*_debian13_amd64.deb   the packages of docs/packages.md
#   trueshade-VERSION-cp311.cp313-*.whl   the Python module for both, with all SIMD targets
#   trueshade-VERSION.tar.xz              the sources
#   SHA256SUMS                            of all of them
# It wants Debian 12, whose glibc is the older one, root, and sources that are committed. TRUESHADE_DEBIAN=FOLDER keeps the
# Debian 13 in which its packages are made there, and goes on with it.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
source scripts/bare_debian.sh
source scripts/release_trials.sh
checkout=$PWD
out=$checkout/out/release
version=$(sed -nE 's/^project\(trueshade VERSION ([0-9.]+) .*/\1/p' CMakeLists.txt)
golden=$(sed -nE 's/.*"builtin:city", "many-lights", 800, 800, "([0-9a-f]{64})".*/\1/p' tests/golden/frames.h)
[[ $(suite_of_this_machine) == "${debian_suites[12]}" && $EUID == 0 ]] || die "./check release: it wants Debian 12, and root"
[[ -z $(git status --porcelain --untracked-files=no) ]] || die "./check release: there are changes that are not committed"
install_packages command debootstrap git patchelf binutils python3 python3-yaml xz-utils
export SOURCE_DATE_EPOCH
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
rm -rf "$out"
mkdir -p "$out"
trials=$(mktemp -d)
trap 'rm -rf --one-file-system "$trials"' EXIT
report=$trials/report
tried() {
  say "tried: $*"
  printf -- '- %s.\n' "${*^}" >>"$report"
}

# collect FOLDER RELEASE: the packages there, under names that say which Debian they are for.
collect() {
  local package
  for package in "$1"/*_"${version}"_amd64.deb; do
    cp "$package" "$out/$(basename "${package/_amd64.deb/_debian$2_amd64.deb}")"
  done
}

say "packages for Debian 12"
scripts/packages.sh
collect build/packages 12
tried "the packages on a bare Debian 12, as ./check packages does"

say "packages for Debian 13"
debian13=${TRUESHADE_DEBIAN:-$trials/making}
root=$debian13
if [[ ! -e $root/etc/debian_version ]]; then
  why=$(make_bare_debian "${debian_suites[13]}" "$root")
  [[ -z $why ]] || die "no bare Debian 13 can be made here: $why"
fi
quietly "git and debootstrap in Debian 13" inside 'apt-get -qq update && apt-get -qq -y --no-install-recommends install git debootstrap'
rm -rf "$root/root/sources.git"
git clone --quiet --bare --depth 1 "file://$checkout" "$root/root/sources.git"
inside '[[ -e /root/sources ]] || git clone --quiet /root/sources.git /root/sources
  cd /root/sources && git fetch --quiet --depth 1 origin HEAD && git reset --quiet --hard FETCH_HEAD && ./check packages'
collect "$root/root/sources/build/packages" 13
tried "the packages on a bare Debian 13, as ./check packages does"

say "the wheel"
# Headers of Debian 13's Python and its pybind11; what reads EXR by Debian 13's OpenImageIO.
headers=$checkout/build/python13/include
rm -rf "$headers"
mkdir -p "$headers/x86_64-linux-gnu"
cp -rL "$debian13"/usr/include/{pybind11,python3.13} "$headers/"
cp -rL "$debian13/usr/include/x86_64-linux-gnu/python3.13" "$headers/x86_64-linux-gnu/"
dpkg-deb -x "$out"/trueshade-image-io_*_debian13_amd64.deb "$trials/image_io"
root=$checkout
configure release "TRUESHADE_OTHER_PYTHON=$checkout/build/python13"
build release trueshade_python trueshade_other_python
scripts/wheel.py build/release "$out" "$(find "$trials/image_io" -name trueshade_image_io.so)" >/dev/null

git archive --format=tar --prefix="trueshade-$version/" HEAD | xz -9 >"$out/trueshade-$version.tar.xz"
(cd "$out" && sha256sum -- *.deb *.whl *.tar.xz >SHA256SUMS)

try_wheel 12
try_wheel 13
try_sources
try_container
try_action 12
try_action 13

# What the page says: what changed, by CHANGELOG.md; the frames, by comparing; the files; what was tried.
{
  printf '# Trueshade %s\n\n' "$version"
  awk '/^## / { ++seen; next } seen == 1' CHANGELOG.md
  printf '## Pictures changed: '
  changed=$(scripts/changed_pictures.sh)
  recorded=$(grep -vc '^#' tests/golden/released.txt)
  if [[ -z $changed ]]; then
    printf 'no\nThe %s golden frames of the last release have their hashes.\n' "$recorded"
  else
    printf 'yes\n%s of the %s golden frames of the last release. Scene, preset, size, hash then and now:\n```text\n%s\n```\n' \
      "$(wc -l <<<"$changed")" "$recorded" "$changed"
  fi
  printf '`builtin:city` under `many-lights` at 800x800 is `sha256:%s`.\n\n## Files\n```text\n' "$golden"
  (cd "$out" && for file in *.deb *.whl *.tar.xz; do printf '%9d  %s\n' "$(stat -c %s "$file")" "$file"; done)
  printf '```\nSHA256SUMS has their sums: `sha256sum --check SHA256SUMS`. docs/packages.md says how to install them.\n\n'
  printf '## Tried\nOn commit %s, %s:\n\n' "$(git rev-parse --short=12 HEAD)" "$(date -u +%F)"
  cat "$report"
} >"$out/release.md"
(cd "$out" && sha256sum --quiet --check SHA256SUMS)
say "the release is in out/release: $(ls "$out" | wc -l) files, $(du -sm "$out" | cut -f1) MB"
