#!/bin/bash
# Fails on a line of more than 120 columns in a guide. Tables are left out, and so are the dated pages of docs/journal.
# Usage: line_widths.sh SOURCE_FOLDER
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$1"
status=0
while IFS= read -r page; do
  number=0
  while IFS= read -r line || [[ -n $line ]]; do
    number=$((number + 1))
    if ((${#line} > 120)) && [[ $line != '|'* ]]; then
      echo "$page:$number: ${#line} columns"
      status=1
    fi
  done <"$page"
done < <(find . -name '*.md' -not -path './build/*' -not -path './out/*' -not -path './.git/*' -not -path './docs/journal/*' | sort)
exit "$status"
