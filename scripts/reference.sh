#!/bin/bash
# scripts/reference.sh, which is ./check docs: the reference of the headers that `cmake --install` installs, by Doxygen, in
# build/docs/html. It is an error where a class or a free function has no comment, and whatever else Doxygen warns of.
# Members, enumerations and constants may leave it to their names.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
command -v doxygen >/dev/null || install_packages picture doxygen
out=build/docs
rm -rf "$out"
mkdir -p "$out"
headers=$(sed -n '/^foreach(header/,/)$/p' cmake/install.cmake | grep -oE '[a-z_/0-9]+\.h' | tr '\n' ' ')
version=$(sed -nE 's/^project\(trueshade VERSION ([0-9.]+) .*/\1/p' CMakeLists.txt)
{
  cat docs/Doxyfile
  printf 'PROJECT_NUMBER = %s\nINPUT = docs/reference.dox %s\nOUTPUT_DIRECTORY = %s\nWARN_LOGFILE = %s/warnings\n' \
    "$version" "$headers" "$out" "$out"
} >"$out/Doxyfile"
quietly "doxygen" doxygen "$out/Doxyfile"
if grep -vE 'warning: Member .* \((variable|enumeration|enumvalue|typedef)\) of .* is not documented|\(function\) of (class|struct) .* is not documented' \
  "$out/warnings"; then
  die "Doxygen warns of these"
fi
say "the reference of $(wc -w <<<"$headers") headers is in $out/html"
