#!/bin/bash
# Draws every picture and compares it with its golden image. Usage: golden.sh [--accept]
# Exit codes: 0 all pass, 1 a picture differs, others as trueshade's.
set -euo pipefail
draw() { trueshade render "$1" --size 64x64 -q -o "$2"; }  # your renderer here
rm -rf out && mkdir -p out/drawn golden
for scene in builtin:cornell scene.json; do
  name=${scene#builtin:}
  draw "$scene" "out/drawn/${name%.json}.png"
done
exec trueshade compare golden out/drawn --pixels 10 --delta 2/255 \
  --junit out/junit.xml -o out/maps -o out/report.html "$@"
