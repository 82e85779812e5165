#!/bin/bash
# scripts/tidy.sh [FILES], which is ./check tidy: clang-tidy by the checks of .clang-tidy, over these sources, or over all but
# the tests, which take three quarters of an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
install_packages command clang clang-tidy
configure tidy TRUESHADE_PARTS=all TRUESHADE_SIMD=native TRUESHADE_TESTS=OFF TRUESHADE_BATCH=1
files=("$@")
((${#files[@]} > 0)) || mapfile -t files < <(sed -nE "s|.*\"file\": \"$PWD/([^\"]*\.cpp)\".*|\1|p" build/tidy/compile_commands.json |
  grep -v '^build/' | sort -u)
say "clang-tidy over ${#files[@]} files"
log=build/tidy/findings
if ! printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/tidy --quiet >"$log" 2>/dev/null; then
  cat "$log"
  die "clang-tidy finds these"
fi
say "clang-tidy finds nothing"
