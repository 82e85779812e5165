#!/bin/bash
# The tables of docs/data/diagnosis.md, from the lines that diagnosis_rows wrote: a row a fault.
# tests/judge/diagnosis/diagnosis_rows.cpp says how to make them.
# Usage: diagnosis_table.sh FILE... [--pairs FILE...] >docs/data/diagnosis.md
#   --pairs: lines of two faults at once
#   EVERY and COMMIT, of the environment: the STEP of diagnosis_rows, and the state that it was built from
#   tries: captures in which the fault changes 100 pixels of the plane by a step of its format
#   legal: of these, captures whose picture differs from a right renderer's in fewer than 100 (legal_witness.h)
set -euo pipefail
(($# >= 1)) || { echo "usage: diagnosis_table.sh FILE... [--pairs FILE...]" >&2; exit 2; }
singles=() pairs=() list=singles
for file in "$@"; do
  if [[ $file == --pairs ]]; then
    list=pairs
  elif [[ $list == pairs ]]; then
    pairs+=("$file")
  else
    singles+=("$file")
  fi
done
awk -F'\t' -v every="${EVERY:-7}" -v commit="${COMMIT:?}" '
  function share(part, whole) { return whole ? sprintf("%.1f %%", 100 * part / whole) : "-" }
  function row(name, t, l, c, a, f, n, b) {
    return "| " name " | " t " | " l " | " share(c, t - l) " | " share(a, t) " | " share(f, t) " | " share(n, t) \
           " | " share(b, n) " |"
  }
  function heading(what) {
    print "| " what " | tries | near legal | convicted | of all | named first | named | its plane |"
    print "|---|---:|---:|---:|---:|---:|---:|---:|"
  }
  $8 >= 100 {
    if (!($1 in tries)) names[++count] = $1
    is_legal = $15 < 100
    ++tries[$1]; any[$1] += $9; first[$1] += $10; named[$1] += $11; blamed[$1] += $12
    legal[$1] += is_legal; convicted[$1] += $9 && !is_legal
    ms += $13; if ($13 > slowest) slowest = $13
    ++all; c += $9; f += $10; n += $11; b += $12; l += is_legal; beyond += $9 && !is_legal
    way = $4 ", " $5
    if (!(way in of_way)) ways[++kinds] = way
    ++of_way[way]; way_any[way] += $9; way_legal[way] += is_legal; way_convicted[way] += $9 && !is_legal
    way_first[way] += $10; way_named[way] += $11; way_blamed[way] += $12
    if (!$9) free[++freed] = "| " $1 " | " $2 ", " $3 ", " $4 ", " $5 ", size " $6 " | " $8 " | " $15 " | " $14 " |"
    if ($9 && $15 == 0) ++unjust
  }
  END {
    print "# Faults planted in captures: convicted, and named"
    print ""
    print "By scripts/diagnosis_table.sh. Each fault is planted in captures of `city` (60 lights, 300 objects), `cornell`"
    print "and `circle` (24 lights), those of colour maps in `lecture`, of 128x96 pixels, as rgba8 and rgba16f, by"
    print "`deferred-loop` and `deferred-volumes`, under one to three presets and in several sizes. Of these one in " every
    print "is tried, and those in which the fault changes fewer than 100 pixels are left out. The capture is a file whose"
    printf "driver has 8 subpixel bits. The rows are of commit %s, whose faults are the %d that are planted here and others.\n", commit, count
    print ""
    print "- *Near legal*: tries whose picture differs from one that a right renderer may draw in fewer than 100 pixels. That"
    print "  renderer is made for each try (`tests/judge/diagnosis/legal_witness.h`): it sums the lights in long double, or"
    print "  within 16 roundings of floats, and converts to codes by one function that does not decrease and stays within 0.6"
    print "  of a code, as D3D11.3 lets hardware do. A judge that is just cannot convict where no pixel differs."
    print "- *Convicted*: the command ends with exit code 1, of the tries that are not near legal; *of all*: of every try."
    print "- *Named first*: the first finding is the fault. *Named*: one of three is."
    print "- *Its plane*: of those named, the plane that is blamed is the one that is wrong."
    print ""
    print "How faults are planted: `tests/judge/diagnosis/plants_of_*.cpp`. A fault whose predictions are those of another,"
    print "such as exposure and intensity where nothing but lights shines, may go by either name."
    print ""
    heading("fault")
    for (i = 1; i <= count; ++i) {
      k = names[i]
      print row(k, tries[k], legal[k], convicted[k], any[k], first[k], named[k], blamed[k])
    }
    print row("**all**", all, l, beyond, c, f, n, b)
    print ""
    heading("strategy and target")
    for (i = 1; i <= kinds; ++i) {
      k = ways[i]
      print row(k, of_way[k], way_legal[k], way_convicted[k], way_any[k], way_first[k], way_named[k], way_blamed[k])
    }
    print ""
    print "Not convicted, with the pixels that the fault changes, and those in which the picture is not legal:"
    print ""
    print "| fault | capture | changed | not legal | findings |"
    print "|---|---|---:|---:|---|"
    for (i = 1; i <= freed; ++i) print free[i]
    print ""
    printf "Convicted although no pixel differs from what a right renderer may draw: %d.\n\n", unjust
    printf "A diagnosis took %.0f ms on average and %.0f ms at most, by the clock of a machine that others used, too.\n", ms / all, slowest
  }' "${singles[@]}"
((${#pairs[@]})) || exit 0
awk -F'\t' '
  $8 >= 100 { ++tries; convicted += $9; both += $11; if (!$11) missed[++count] = "| " $1 " | " $14 " |" }
  END {
    printf "\n## Two faults at once\n"
    printf "Of %d pairs, each fault of which changes 100 pixels beside the other, %d are convicted.\n", tries, convicted
    printf "Both faults are named in %d (%.1f %%). The others:\n\n", both, 100 * both / tries
    print "| faults | findings |\n|---|---|"
    for (i = 1; i <= count; ++i) print missed[i]
  }' "${pairs[@]}"
