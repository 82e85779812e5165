#!/bin/bash
# Fails unless TRUESHADE_PARTS=picture configures trueshade-picture, and looks for no package beyond the first part of
# scripts/packages.txt. Usage: picture_parts.sh SOURCE_FOLDER COMPILER
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake -S "$1" -B "$work" -G Ninja -DCMAKE_CXX_COMPILER="$2" -DTRUESHADE_PARTS=picture >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
ninja -C "$work" -n trueshade_picture >/dev/null
if found=$(grep -iE '^(OIIO|EPOXY|embree|meshoptimizer|TRUESHADE_GLSLANG)' "$work/CMakeCache.txt"); then
  printf 'packages that the picture does not need:\n%s\n' "$found"
  exit 1
fi
