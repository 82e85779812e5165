#!/bin/bash
# Fails where the table of docs/gl_rules.md and the tests do not fit: each row from 1 to 64 stands there once, and every file
# that it names speaks of that row ("Row 7", "rows 42 to 46"). Usage: rows.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
fail() {
  echo "$1"
  status=1
}

# rows_of FILE: the numbers of all rows that a file speaks of, one a line.
rows_of() {
  local text number last
  while read -r text; do
    last=
    for word in ${text//,/ }; do
      case $word in
        to) last=to ;;
        [0-9]*) number=${word%%[^0-9]*}
          if [[ $last == to ]]; then seq "$((previous + 1))" "$number"; else echo "$number"; fi
          previous=$number last= ;;
      esac
    done
  done < <(grep -ohiE "rows? [0-9]+((,| and|, and| to) [0-9]+)*" "$1")
}

expected=1
while IFS='|' read -r _ number _ _ files; do
  ((number == expected)) || fail "row $expected is not in its place; row $number stands there"
  expected=$((number + 1))
  found=$(grep -oE '`[^`]+`' <<<"$files" | tr -d '`')
  [[ -n $found ]] || fail "row $((number)) names no test"
  for file in $found; do
    [[ " $(rows_of "$file" | tr '\n' ' ')" == *" $((number)) "* ]] || fail "row $((number)): $file does not speak of it"
  done
done < <(grep -E '^\| [0-9]+ \|.*`tests/' docs/gl_rules.md)
((expected == 65)) || fail "the last row is $((expected - 1))"
exit "$status"
