#!/bin/bash
# scripts/packages.sh, which is ./check packages: makes the Debian packages under build/packages (docs/packages.md), and
# tries them in a bare Debian of this machine's release: debootstrap makes one from where this machine's apt has its
# packages. Where that cannot be done, says so, and tries the packages' content where dpkg-deb unpacks it. Last lines: sizes, times, the verdict.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
source scripts/bare_debian.sh
out=build/packages
suite=$(suite_of_this_machine)
golden=$(sed -nE 's/.*"builtin:city", "many-lights", 800, 800, "([0-9a-f]{64})".*/\1/p' tests/golden/frames.h)

install_packages command python3 libopenmpi-dev pybind11-dev python3-dev python3-numpy libsdl2-dev libimgui-dev dpkg-dev binutils file gzip xz-utils
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 0)}
tests=()
[[ -e build/release/build.ninja ]] || tests=(TRUESHADE_TESTS=OFF)
configure release "${tests[@]}" TRUESHADE_PARTS=all "TRUESHADE_SIMD=avx512;avx2;sse4;scalar" TRUESHADE_PYTHON=ON CMAKE_INSTALL_PREFIX=/usr \
  "CMAKE_INSTALL_LIBDIR=lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)"
targets=(trueshade trueshade_image_io trueshade_image_io_module trueshade_mpi_module trueshade_python)
ninja -C build/release -t query trueshade_view_program >/dev/null 2>&1 && targets+=(trueshade_view_program)
for target in "${targets[@]}"; do build release "$target"; done

# make_packages FOLDER: all packages of the build.
make_packages() {
  rm -rf "$1"
  quietly cpack cpack --config build/release/CPackConfig.cmake -B "$1"
  rm -rf "$1/_CPack_Packages"
}
make_packages "$out/again"
make_packages "$out/now"
mv "$out/now"/*.deb "$out/again/.." 2>/dev/null || true
for package in "$out/again"/*.deb; do
  cmp -s "$package" "$out/${package##*/}" || die "$package: made twice, it is not the same bytes"
done
rm -rf "$out/again" "$out/now"
for package in "$out"/*.deb; do printf '%8d kB  %s\n' "$(($(stat -c %s "$package") / 1000))" "${package##*/}"; done

if command -v lintian >/dev/null; then
  lintian --fail-on error --suppress-tags initial-upload-closes-no-bugs "$out"/*.deb || die "lintian finds errors"
  say "lintian finds no errors"
else
  say "lintian is not installed: passed over"
fi

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/root
why=$(make_bare_debian "$suite" "$root")
if [[ -n $why ]]; then
  say "no bare Debian can be made here ($why); trying what dpkg-deb unpacks"
  for package in "$out"/*.deb; do dpkg-deb -x "$package" "$work/root"; done
  hash=$("$work/root/usr/bin/trueshade" render builtin:city -o "$work/city.png" --hash 2>"$work/log") || die "$(cat "$work/log")"
  [[ $hash == "sha256:$golden "* ]] || die "builtin:city has the hash $hash"
  PYTHONPATH=$work/root/usr/lib/python3/dist-packages /usr/bin/python3 -c 'import trueshade'
  say "the packages' content draws builtin:city with the golden hash, and the module is imported"
  exit 0
fi

cp "$out"/*.deb "$root/root/"
cp -r tests/consumer "$root/root/"
quietly "apt-get update in the bare Debian" inside 'apt-get -qq update'

SECONDS=0
quietly "apt install ./trueshade_*.deb" inside 'cd /root && apt-get -qq -y install ./trueshade_*.deb'
installed=$SECONDS
hash=$(inside 'cd /root && trueshade render builtin:city -o city.png --hash 2>/dev/null')
((SECONDS < 60)) || die "from bare Debian to the picture took $SECONDS s, and a minute is promised"
say "apt install ./trueshade_*.deb took $installed s, builtin:city was there after $SECONDS s"
[[ $hash == "sha256:$golden "* ]] || die "builtin:city has the hash $hash"
inside '! command -v gcc && ! command -v g++ && ! command -v cc' >/dev/null || die "a compiler was installed"
for simd in $(inside 'trueshade list --json' | grep -oE '"simd": \[[^]]*' | grep -oE '[a-z0-9]+' | tail -n +2); do
  [[ $(inside "trueshade render builtin:city --hash --simd $simd") == "$hash" ]] || die "--simd $simd has another hash"
done

SECONDS=0
quietly "apt install of the module" inside 'cd /root && apt-get -qq -y --no-install-recommends install ./python3-trueshade_*.deb'
inside 'cd /root && python3 -c "
import trueshade
frame = trueshade.render(trueshade.load_scene(\"builtin:city\"))
print(frame.hash)"' | grep -q "$golden" || die "the Python module has another hash"
say "python3-trueshade was installed in $SECONDS s and draws the same"

SECONDS=0
quietly "apt install of the library" inside 'cd /root && apt-get -qq -y --no-install-recommends install ./libtrueshade-dev_*.deb g++ cmake ninja-build pkg-config libopenimageio-dev'
quietly "tests/consumer against the library" inside 'cd /root && cmake -S consumer -B built -G Ninja -DCMAKE_BUILD_TYPE=Release && cmake --build built && built/consumer picture.png && trueshade info picture.png'
say "libtrueshade-dev was installed, and a program built with it, in $SECONDS s"

if compgen -G "$out/trueshade-view_*.deb" >/dev/null; then
  quietly "apt install of the viewer" inside 'cd /root && apt-get -qq -y --no-install-recommends install ./trueshade-view_*.deb'
  say "trueshade-view was installed"
fi
quietly "apt install of trueshade-mpi" inside 'cd /root && apt-get -qq -y --no-install-recommends install ./trueshade-mpi_*.deb openmpi-bin'
[[ $(inside 'mpirun --allow-run-as-root --oversubscribe -n 2 trueshade render builtin:city --frames 0-1 --hash | head -n 1') == "$hash" ]] ||
  die "two ranks of MPI draw another hash"
say "trueshade-mpi was installed, and two ranks draw the same"

quietly "apt remove" inside 'apt-get -qq -y purge "trueshade*" "libtrueshade*" python3-trueshade && ! command -v trueshade'
left=$(inside 'find / -xdev -name "*trueshade*" -not -path "/root/*" -not -path "/proc/*" -not -path "/var/lib/apt/*"')
[[ -z $left ]] || die "apt purge leaves: $left"
say "the packages are right"
