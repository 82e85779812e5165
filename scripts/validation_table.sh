#!/bin/bash
# The tables of docs/data/validation_*.md, from the lines that validation_rows wrote (tests/judge/validation_rows.cpp
# says how to make them): a file a driver and profile, a row a scene, size and strategy, pixels summed over the presets.
# Usage: validation_table.sh FOLDER FILE...   (docs/data is the folder of the guides)
#   lit: the least share of a preset's pixels with a surface that are EXACT or STORE-2, or TEX in a G-buffer
#   seen / predicted: EDGE + DEPTH-TIE + CLIP + BRANCH pixels and how many are expected at most; in brackets the largest
#   quotient of a preset
# Prints the names of the files. Ends with status 1 where a pixel is in no legal set.
set -euo pipefail
(($# >= 2)) || { echo "usage: validation_table.sh FOLDER FILE..." >&2; exit 2; }
folder=$1
shift
awk -F'\t' -v folder="$folder" '
  function row(key,  i, line) {
    line = "| " label[key] " | " presets[key] " |"
    for (i = 1; i <= 9; ++i) line = line " " sum[key, i] + 0 " |"
    return line sprintf(" %.3f %% | %d / %.1f (%.2f) |", least[key], seen[key], predicted[key], largest[key])
  }
  # A frame may have been begun twice: the last line counts.
  { for (i = 1; i <= 7; ++i) id = i == 1 ? $i : id FS $i
    if (!(id in line_of)) ids[++count] = id
    line_of[id] = $0 }
  END {
    for (c = 1; c <= count; ++c) {
      $0 = line_of[ids[c]]
      title = $5 FS $4; geometry = $7 == "gbuffer"
      key = title FS $1 FS $6 FS (geometry ? "" : $2) FS $7
      if (!(key in presets)) {
        label[key] = $1 " " $6 ", " (geometry ? "G-buffer" : $2 ($7 == "lighting" && ($2 ~ /volumes|multipass/) ? ", last image" : ""))
        if (!(title in rows)) titles[++tables] = title
        order[title, ++rows[title]] = key; least[key] = 100
      }
      ++presets[key]
      for (i = 1; i <= 9; ++i) sum[key, i] += $(8 + i)
      others = $11 + $12 + $13 + $14 + $16 + $17
      if ($8 > 0 && 100 * ($8 - others) / $8 < least[key]) least[key] = 100 * ($8 - others) / $8
      seen[key] += $18; predicted[key] += $19
      quotient = $18 == 0 ? 0 : $19 == 0 ? 999 : $18 / $19
      if (quotient > largest[key]) largest[key] = quotient
      violations += $17
    }
    for (t = 1; t <= tables; ++t) {
      split(titles[t], part, FS)
      out = folder "/validation_" part[1] "_" part[2] ".md"
      print "# " part[1] ", held to `" part[2] "`\n" > out
      print "Written by `scripts/validation_table.sh`. [validation.md](../validation.md#what-the-classes-mean) explains the classes,\n[drivers.md](drivers.md#every-scene-under-every-preset-and-strategy) the rows and the last two columns.\n" > out
      print "| scene, strategy | frames | EXACT | STORE-2 | EDGE | DEPTH-TIE | CLIP | BRANCH | TEX | UNDEFINED | VIOLATION | lit | seen / predicted |" > out
      print "|---|---|---|---|---|---|---|---|---|---|---|---|---|" > out
      for (i = 1; i <= rows[titles[t]]; ++i) print row(order[titles[t], i]) > out
      close(out)
      print out
    }
    exit violations > 0
  }' "$@"
