#!/bin/bash
# tests/night_rows.sh SOURCE_DIR: every row of docs/data/night.md says that its part passed, on a commit that is one of the
# last hundred. What CI leaves out does not rot in silence.
set -euo pipefail
cd "$1"
git rev-parse --git-dir >/dev/null 2>&1 || { echo "SKIPPED: this is no clone of the repository"; exit 0; }
[[ $(git rev-parse --is-shallow-repository) == false ]] || { echo "SKIPPED: the clone is shallow"; exit 0; }
rows=0
status=0
while IFS='|' read -r _ part _ commit _ _ verdict _; do
  rows=$((rows + 1))
  part=${part// /} commit=${commit// /}
  behind=$(git rev-list --count "$commit..HEAD" 2>/dev/null) || behind=unknown
  if ! git merge-base --is-ancestor "$commit" HEAD 2>/dev/null; then
    echo "docs/data/night.md: $part ran on $commit, which this state does not come from"
    status=1
  elif ((behind > 100)); then
    echo "docs/data/night.md: $part ran $behind commits ago; ./check night $part"
    status=1
  fi
  [[ $verdict == ' passed'* ]] || { echo "docs/data/night.md: $part:$verdict"; status=1; }
done < <(grep -E '^\| [a-z0-9-]+ \| `' docs/data/night.md)
((rows > 0)) || { echo "docs/data/night.md has no row"; exit 1; }
exit "$status"
