#!/bin/bash
# The tables of docs/validation.md as Markdown: every scene under every preset and strategy on a driver.
# Usage: validation_table.sh COMMAND DRIVER SIZE [OPTION...]   options go to `trueshade validate`
#   SCENES, PRESETS, STRATEGIES: lists of what to judge, all that `trueshade list` names unless set
#   SUMMED=1: a row a scene and strategy, the target's pixels summed over the presets
# Ends with status 1 where a pixel is in no legal set, or something was refused (a row says what).
set -euo pipefail
command=$1 driver=$2 size=$3
shift 3

# names HEADING: the entries of that section of `trueshade list`.
names() { "$command" list | awk -v heading="$1" '/^[^ ]/ {on = index($0, heading) == 1} /^  / && on {print $1}'; }

classes='EXACT STORE-2 EDGE DEPTH-TIE CLIP BRANCH TEX UNDEFINED VIOLATION'
status=0
columns=$(sed 's/ / | /g' <<<"$classes")
if [[ -n ${SUMMED:-} ]]; then
  echo "| scene, strategy | presets | $columns | seen / predicted |"
  echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
else
  echo "| scene, preset, strategy | stage | $columns | seen / predicted | judged |"
  echo '|---|---|---|---|---|---|---|---|---|---|---|---|---|'
fi
for scene in ${SCENES:-$(names Scenes)}; do
  for strategy in ${STRATEGIES:-$(names Strategies)}; do
    texts=
    for preset in ${PRESETS:-$(names Presets)}; do
      text=$("$command" validate "builtin:${scene#builtin:}" --preset "$preset" --strategy "$strategy" --driver "$driver" \
        --size "$size" --quick "$@" 2>&1) || status=1
      texts+="name ${scene#builtin:}, $preset, $strategy"$'\n'"$text"$'\n'
    done
    awk -v summed="${SUMMED:-}" -v sum_name="${scene#builtin:}, $strategy" -v classes="$classes" '
      function flush(  i) { if (stage == "") return
        if (!summed) {
          printf "| %s | %s |", name, stage
          for (i = 1; i <= n; ++i) printf " %d |", count[order[i]]
          printf " %s / %s | %s |\n", seen, predicted, seconds
        } else if (stage != "gbuffer") {
          if (stage != "transparency") ++presets; sum_seen += seen; sum_predicted += predicted
          for (i = 1; i <= n; ++i) sum[order[i]] += count[order[i]]
        }
        split("", count); stage = "" }
      BEGIN { n = split(classes, order, " ") }
      /^name / { flush(); name = substr($0, 6) }
      /^trueshade: error: / { print "| " name " | " substr($0, 19) " |" }
      /judged in/ { seconds = $(NF - 1) " s" }
      /^(gbuffer|lighting|blending|transparency):/ { flush(); stage = substr($1, 1, length($1) - 1) }
      /^  [A-Z0-9-]+ +[0-9]+ +[0-9.]+ %$/ { count[$1] = $2 }
      /other surfaces or branches/ { seen = $5; predicted = $7 }
      END { flush()
        if (summed) {
          printf "| %s | %d |", sum_name, presets
          for (i = 1; i <= n; ++i) printf " %d |", sum[order[i]]
          printf " %d / %.1f |\n", sum_seen, sum_predicted } }' <<<"$texts"
  done
done
exit "$status"
