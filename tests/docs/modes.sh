#!/bin/bash
# Fails where a mode of ./check is not in the comment that it opens with, in what it says of an unknown mode, or in the table
# of docs/testing.md. Usage: modes.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
fail() {
  printf '%s\n' "$1"
  status=1
}
comment=$(sed -n '2,/^set /p' check | grep '^#')
unknown=$(grep -oE 'there is no mode .*' check)
mapfile -t modes < <(sed -n '/^case \$mode in/,/^esac/p' check | grep -oE '^  [a-z][a-z0-9 |-]*\)' | grep -oE '[a-z0-9-]+')
((${#modes[@]} > 10)) || fail "check has no list of modes that this test can read"
for mode in "${modes[@]}"; do
  [[ $mode != quick ]] || continue
  grep -qE "^#( .*)?   ?$mode( |\$)" <<<"$comment" || fail "the comment of ./check does not say what $mode runs"
  grep -qE "[ :]$mode[ ,]" <<<"$unknown" || fail "./check does not name $mode where it knows no mode of a name"
  grep -qE "^\| \`\./check $mode( |\`)" docs/testing.md || fail "docs/testing.md has no row for ./check $mode"
done
exit "$status"
