#!/bin/bash
# Says which golden frames of the last release (tests/golden/released.txt) have another hash in tests/golden/frames.h now,
# or are no longer there: a line each, `SCENE PRESET WIDTHxHEIGHT OLD_HASH NEW_HASH`, with `gone` for the new hash of what is
# not there. Says nothing where no picture has changed. With --all: every golden frame of today, as released.txt has them.
set -euo pipefail
cd "$(dirname "$0")/.."

# golden_frames: `SCENE PRESET WIDTHxHEIGHT HASH` of each row of frames.h, which may stand on two lines.
golden_frames() {
  tr '\n' ' ' <tests/golden/frames.h | grep -oE '\{"builtin:[^}]*\}' |
    sed -E 's/\{"([^"]*)", "([^"]*)", ([0-9]+), ([0-9]+), +"([0-9a-f]{64})"\}/\1 \2 \3x\4 \5/'
}

if [[ ${1:-} == --all ]]; then
  golden_frames
  exit
fi
declare -A now
while read -r scene preset size hash; do now["$scene $preset $size"]=$hash; done < <(golden_frames)
((${#now[@]} > 0)) || { echo "tests/golden/frames.h names no frame" >&2; exit 1; }
while read -r scene preset size hash; do
  if [[ $scene != \#* && ${now["$scene $preset $size"]:-gone} != "$hash" ]]; then
    echo "$scene $preset $size $hash ${now["$scene $preset $size"]:-gone}"
  fi
done <tests/golden/released.txt
