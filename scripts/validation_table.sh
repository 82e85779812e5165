#!/bin/bash
# The tables of docs/validation.md: every built-in scene under every preset on a driver, a row each, as Markdown.
# Usage: validation_table.sh COMMAND DRIVER SIZE [OPTION...]   options go to `trueshade validate`
# Ends with status 1 where a pixel is in no legal set.
set -euo pipefail
command=$1 driver=$2 size=$3
shift 3

# names HEADING: the entries of that section of `trueshade list`.
names() { "$command" list | awk -v heading="$1" '/^[^ ]/ {on = index($0, heading) == 1} /^  / && on {print $1}'; }

status=0
echo '| scene, preset | stage | EXACT | STORE-2 | EDGE | DEPTH-TIE | CLIP | BRANCH | UNDEFINED | VIOLATION | seen / predicted | judged |'
echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
while read -r scene; do
  for preset in $(names Presets); do
    text=$("$command" validate "builtin:${scene#builtin:}" --preset "$preset" --driver "$driver" --size "$size" --quick "$@") || status=1
    awk -v name="${scene#builtin:}, $preset" '
      function flush() { if (stage == "") return
        printf "| %s | %s |", name, stage
        n = split("EXACT STORE-2 EDGE DEPTH-TIE CLIP BRANCH UNDEFINED VIOLATION", order, " ")
        for (i = 1; i <= n; ++i) printf " %d |", count[order[i]]
        printf " %s | %s |\n", seen, seconds; split("", count) }
      /judged in/ { seconds = $(NF - 1) " s" }
      /^(gbuffer|lighting):/ { flush(); stage = substr($1, 1, length($1) - 1) }
      /^  [A-Z0-9-]+ +[0-9]+ +[0-9.]+ %$/ { count[$1] = $2 }
      /other surfaces or branches/ { seen = $5 " / " $7 }
      END { flush() }' <<<"$text"
  done
done < <(names Scenes)
exit "$status"
