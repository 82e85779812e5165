#!/bin/bash
# Draws a terrain without a cache file, where it makes one, and from it. Fails where a hash, the memory or the time to
# the first tile is not as it should be.
# Usage: terrain.sh TRUESHADE MAKE_TERRAIN PEAK_MEMORY PATCHES QUADS MOST_MIB MOST_MS
# Terrains above 10 million triangles are not drawn without a cache file, which takes more memory.
set -euo pipefail
trueshade=$1 make=$2 peak=$3 patches=$4 quads=$5 most_mib=$6 most_ms=$7
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$make" "$folder" "$patches" "$quads"
sleep 0.1 # a scene is not kept whose files were written a moment ago
triangles=$((2 * patches * patches * quads * quads))
draw=("$trueshade" render "$folder/scene.json" --size 1280x720 --hash --stats)
limits=(--max-memory "${most_mib}M")

# run NAME ARGUMENT...: prints a line of figures and sets `hash`, `mib` and `ms`.
run() {
  local name=$1 printed
  shift
  printed=$("$peak" "$@")
  hash=$(grep -o 'sha256:[0-9a-f]*' <<<"$printed")
  mib=$(($(grep -oP '^peak \K\d+' <<<"$printed") / 1024))
  ms=$(grep -oP 'first tile \[ms\] +\K\d+' <<<"$printed")
  printf '%-14s %11d triangles  first tile after %6d ms  %5d MiB  %.20s\n' "$name" "$triangles" "$ms" "$mib" "$hash"
}
fail() { echo "$1"; exit 1; }

if ((triangles <= 10000000)); then
  run 'without' "${draw[@]}"
  expected=$hash
fi
run 'made' "${draw[@]}" "${limits[@]}" --cache "$folder/kept"
expected=${expected:-$hash}
[[ $hash == "$expected" ]] || fail 'the picture is another one where the cache file is made'
((mib <= most_mib)) || fail "more than $most_mib MiB"
for name in 'from the file' 'once more'; do
  run "$name" "${draw[@]}" "${limits[@]}" --cache "$folder/kept"
  [[ $hash == "$expected" ]] || fail 'the picture is another one from the cache file'
  ((mib <= most_mib)) || fail "more than $most_mib MiB"
  ((ms <= most_ms)) || fail "the first tile came after more than $most_ms ms"
done
