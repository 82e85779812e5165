#!/bin/bash
# Installs a build into a fresh prefix, builds a program against it with find_package(trueshade), and runs it.
# Usage: run.sh BUILD_FOLDER SOURCE_FOLDER COMPILER CXX_FLAGS
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; exit 1; }
cmake -S "$2/tests/consumer" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$3" \
  -DCMAKE_CXX_FLAGS="$4" -DCMAKE_PREFIX_PATH="$work/prefix"
cmake --build "$work/build"
read -r hash lit < <("$work/build/consumer" "$work/picture.png")
echo "hash $hash, $lit pixels lit"
[[ $hash =~ ^[0-9a-f]{64}$ && $lit -gt 400 && -s $work/picture.png ]]
"$work/prefix/bin/trueshade" info "$work/picture.png"
for schema in $(grep -o '[a-z]*\.schema\.json' < <("$work/prefix/bin/trueshade" list)); do
  [[ -s $work/prefix/share/trueshade/$schema ]]
done
[[ -s $work/prefix/share/trueshade/scene.schema.json ]]
