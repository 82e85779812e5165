#!/bin/bash
# Fails where a library holds a fused multiply-add, which rounds once where the page says twice, or an estimate of 1/x or
# 1/sqrt(x), whose bits differ between CPUs. Estimates may stand in functions named *bounded_*, whose results are used where
# a bound of their error shows that they have the right codes (docs/proofs.md section 17). Fails too where a mask of 8
# or 16 lanes is spilled and read back as 32 bits (core/simd/lane_bits-inl.h), by the last write above in the listing. Usage:
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
# Reads of 32 and 64 bits from where the last write above was of a mask of fewer. A slot that the function also fills with
# 64 or 32 bits at once is shared with a pointer or a count: reads of as many bits there are that one's, which a jump leads
# to.
widened_masks() {
  awk '
    function slot_of(line) { return match(line, /-?(0x[0-9a-f]+)?\(%r[sb]p\)/) ? substr(line, RSTART, RLENGTH) : "" }
    function judge(  i, at, word) {
      delete whole; delete half; delete spilled
      for (i = 1; i <= count; ++i) {
        split(line[i], word, " ")
        at = slot_of(line[i])
        if (at != "" && line[i] ~ /\(%r[sb]p\)$/ && (word[2] == "movq" || (word[2] == "mov" && line[i] ~ whole_register))) whole[at] = 1
        else if (at != "" && line[i] ~ /\(%r[sb]p\)$/ && (word[2] == "movl" || (word[2] == "mov" && line[i] ~ half_register))) half[at] = 1
      }
      for (i = 1; i <= count; ++i) {
        at = slot_of(line[i])
        if (at == "") continue
        split(line[i], word, " ")
        if (line[i] ~ /\(%r[sb]p\)$/ && word[2] ~ /^kmov[bw]$/) spilled[at] = word[2]
        else if (line[i] ~ /\(%r[sb]p\)$/ && word[2] ~ /^(v?mov|vextract|kmov)/) delete spilled[at]
        else if (!(at in spilled)) continue
        else if ((at in whole) && (word[2] ~ /q$/ || line[i] ~ whole_register)) continue
        else if ((at in half) && (word[2] ~ /l$/ || line[i] ~ half_register)) continue
        else if (word[2] ~ /^kmov/ ? word[2] != spilled[at] && word[2] != "kmovb" : word[2] !~ /^(v|movz|movs|lea)/ && (word[2] ~ /[lq]$/ || line[i] ~ wide)) print name, line[i]
      }
      count = 0
    }
    /^[0-9a-f]+ <.*>:$/ { judge(); name = $2; next }
    { line[++count] = $0 }
    END { judge() }' wide='%(e[a-d]x|e[sd]i|e[sb]p|r[a-d]x|r[sd]i|r[0-9]+d?[,) ]|r[0-9]+d?$)' \
    whole_register='%r([a-d]x|[sd]i|[0-9]+)(,|$)' half_register='%(e[a-d]x|e[sd]i|r[0-9]+d)(,|$)'
}
bad='0 <f>:
 1:	kmovb  %k1,0x8(%rsp)
 2:	mov    0x8(%rsp),%eax
 3:	mov    0x8(%rsp),%ebp
 4:	mov    0x8(%rsp),%r9
 5:	kmovd  0x8(%rsp),%k2
 6:	cmpl   $0x1,0x8(%rsp)'
fine='0 <f>:
 1:	kmovw  %k1,0x8(%rsp)
 2:	movzwl 0x8(%rsp),%eax
 3:	kmovw  0x8(%rsp),%k1
 4:	mov    %r9d,0x8(%rsp)
 5:	mov    0x8(%rsp),%eax
 6:	mov    %r12,0x10(%rsp)
 7:	kmovw  %k1,0x10(%rsp)
 8:	mov    0x10(%rsp),%r12
 9:	mov    %ebx,0x18(%rsp)
 10:	kmovb  %k1,0x18(%rsp)
 11:	mov    0x18(%rsp),%r9d'
if [[ $(widened_masks <<<"$bad" | wc -l) != 5 || -n $(widened_masks <<<"$fine") ]]; then
  echo "widened masks are not told from others"
  exit 1
fi
status=0
for library in "$@"; do
  found=$("$objdump" -d --no-show-raw-insn "$library" | awk '
    /^[0-9a-f]+ <.*>:$/ { name = $2 }
    $2 ~ /^('"$fused|$estimates"')$/ && !(name ~ /bounded_/ && $2 ~ /^('"$bounded"')$/) { print name " " $2 }' | sort | uniq -c | sort -rn)
  instructions=$("$objdump" -d --no-show-raw-insn "$library" | wc -l)
  echo "${library##*/}: $instructions lines of disassembly"
  widened=  # a fault of g++; clang reuses places in orders that this way of reading takes for it
  grep -aq 'clang version' "$library" || widened=$("$objdump" -d --no-show-raw-insn "$library" | widened_masks)
  for lines in "$found" "$widened"; do
    [[ -z $lines ]] && continue
    printf '%s\n' "$lines" | head -n 20
    status=1
  done
done
exit "$status"
