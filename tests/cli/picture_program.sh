#!/bin/bash
# Fails unless trueshade-picture, with which ./run draws at first, writes the files that trueshade writes, and refuses all
# else in one line. Usage: picture_program.sh TRUESHADE TRUESHADE_PICTURE
set -euo pipefail
trueshade=$(realpath "$1") picture=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
scene=builtin:city,objects=40,lights=9
for program in "$trueshade" "$picture"; do
  mkdir "${program##*/}"
  "$program" render "$scene" --size 96x64 -o "${program##*/}/a.png" -o "${program##*/}/a.exr" --aov depth,normal --hash -q >"${program##*/}/hash"
done
diff -r trueshade trueshade-picture
[[ $(wc -c <trueshade/hash) -gt 64 ]]

refused() {
  local status=0
  "$picture" "$@" >out 2>err || status=$?
  [[ $status == 2 && ! -s out && $(wc -l <err) == 1 && $(<err) == "trueshade: error: trueshade-picture: "*"(use trueshade, "*")" ]] ||
    { printf '%s: exit code %s, said: %s\n' "$*" "$status" "$(<err)"; exit 1; }
}
refused render scene.json --hash
refused validate "$scene"
refused bench "$scene"
refused list
