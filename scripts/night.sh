#!/bin/bash
# scripts/night.sh [PART...], which is ./check night: runs the parts of docs/data/night.md, all of them or those named, and
# writes into each part's row the commit, the day, the minutes and the last line. A test of ./check full fails where a row
# is of a commit 100 commits ago, or names a failure (tests/night_rows.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
page=docs/data/night.md
[[ -z $(git status --porcelain --untracked-files=no) ]] || die "./check night: commit first; the page names the commit that ran"
commit=$(git rev-parse --short=8 HEAD)
mapfile -t parts < <(sed -nE 's/^\| ([a-z0-9-]+) \| `.*/\1/p' "$page")
(($# == 0)) || parts=("$@")

# command_of PART: what its row says to run.
command_of() { sed -nE "s/^\| $1 \| \`([^\`]*)\` \|.*/\1/p" "$page"; }

# write_row PART VERDICT MINUTES: the row of PART, anew. A verdict is printed by our own commands, so no character of it is
# special but those that are escaped here.
write_row() {
  local verdict=${2//[|\\&\/]/ }
  sed -i -E "s/^(\| $1 \| \`[^\`]*\` \|).*/\1 $commit | $(date -u +%Y-%m-%d) | $3 min | $verdict |/" "$page"
}

failed=()
log=$(mktemp)
trap 'rm -f "$log"' EXIT
for part in "${parts[@]}"; do
  [[ -n $(command_of "$part") ]] || die "./check night: there is no part '$part' (one of: $(sed -nE 's/^\| ([a-z0-9-]+) \| `.*/\1/p' "$page" | tr '\n' ' '))"
  say "night: $part"
  SECONDS=0
  verdict=passed
  bash -c "$(command_of "$part")" >"$log" 2>&1 </dev/null || verdict=failed
  [[ $verdict == passed ]] || { cat "$log"; failed+=("$part"); }
  write_row "$part" "$verdict: $(grep -v '^$' "$log" | tail -n 1)" $(((SECONDS + 30) / 60))
done
grep '^| ' "$page"
((${#failed[@]} == 0)) || die "./check night: failed: ${failed[*]}"
