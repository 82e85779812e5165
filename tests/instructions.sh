#!/bin/bash
# Fails where a library holds a fused multiply-add, which rounds once where the page says twice, or an estimate of 1/x or
# 1/sqrt(x), whose bits differ between CPUs. Estimates may stand in functions named settle_*, whose results are used where
# a bound of their error shows that they have the right codes (docs/arithmetic.md section 17). Fails too where a mask of 8
# or 16 lanes is spilled and read back as 32 bits (raster/lane_bits-inl.h), by the last write above in the listing. Usage:
# instructions.sh OBJDUMP LIBRARY...
set -euo pipefail
objdump=$1
shift
case $("$objdump" -f "$1" | grep -m 1 architecture) in
  *x86-64*) fused='vfn?m(add|sub|addsub|subadd)[0-9]*[ps][sdh]' bounded='v?rsqrt(14)?ps|v?rcp(14)?ps'
            estimates='v?rsqrt(14|28)?[ps][sdh]|v?rcp(14|28)?[ps][sdh]|vexp2p[sd]|vrsqrtph|vrcpph' ;;
  *aarch64*) fused='fn?m(add|sub)|fml[as]' bounded='frsqrte|frecpe' estimates='frecp[esx]|frsqrt[es]' ;;
  *) echo "SKIPPED: no list of instructions for this architecture"; exit 4 ;;
esac
status=0
for library in "$@"; do
  found=$("$objdump" -d --no-show-raw-insn "$library" | awk '
    /^[0-9a-f]+ <.*>:$/ { name = $2 }
    $2 ~ /^('"$fused|$estimates"')$/ && !(name ~ /settle_/ && $2 ~ /^('"$bounded"')$/) { print name " " $2 }' | sort | uniq -c | sort -rn)
  instructions=$("$objdump" -d --no-show-raw-insn "$library" | wc -l)
  echo "${library##*/}: $instructions lines of disassembly"
  widened=$("$objdump" -d --no-show-raw-insn "$library" | awk '
    /^[0-9a-f]+ <.*>:$/ { name = $2; delete spilled; next }
    match($0, /-?(0x[0-9a-f]+)?\(%r[sb]p\)/) {
      slot = substr($0, RSTART, RLENGTH); written = RSTART + RLENGTH > length($0)
      if (written && $2 ~ /^kmov[bw]$/) spilled[slot] = 1
      else if (written && $2 ~ /^(v?mov|vextract|kmov)/) delete spilled[slot]
      else if (slot in spilled && $2 !~ /^(v|kmov|movz|movs)/ && ($2 ~ /l$/ || $0 ~ /%(e[a-d]x|e[sd]i|r[0-9]+d)/)) print name, $0
    }')
  for lines in "$found" "$widened"; do
    [[ -z $lines ]] && continue
    printf '%s\n' "$lines" | head -n 20
    status=1
  done
done
exit "$status"
