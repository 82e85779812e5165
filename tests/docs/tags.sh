#!/bin/bash
# Fails on a fenced block of a guide that no test looks at. README.md and docs/*.md hold the languages that tests/docs/page.sh,
# tests/docs/python_page.py and tests/consumer/run.sh run, and `console` and `yaml` for what no test can run: each of those blocks has a row in
# tests/docs/not_run.txt, with the reason. Every other Markdown file holds `text` alone. Usage: tags.sh SOURCE_FOLDER
set -euo pipefail
shopt -s extglob
cd "$1"
status=0
fail() {
  printf '%s\n' "$1"
  status=1
}

declare -A reasons seen
while IFS='|' read -r page line reason; do
  [[ -z $page || $page == \#* ]] || reasons[$page:$line]=$reason
done <tests/docs/not_run.txt

while IFS= read -r page; do
  number=0 language= console=
  while IFS= read -r line || [[ -n $line ]]; do
    number=$((number + 1))
    if [[ -n $console ]]; then
      seen[$page:$line]=yes console=
      [[ -v reasons[$page:$line] ]] || fail "$page:$number: no row of tests/docs/not_run.txt says why this is not run: $line"
    fi
    if [[ $line != *'```'* ]]; then continue; fi
    if [[ -n $language && $line == '```' ]]; then
      language=
      continue
    fi
    [[ $line == '```'* && -z $language ]] || { fail "$page:$number: a fence stands by itself, at the start of its line"; continue; }
    language=${line#'```'}
    case $page:$language in
      *:text) ;;
      README.md:@(sh|json|ply|csv|glsl|bash|python|cmake|cpp) | docs/+([^/]).md:@(sh|sh python|json|ply|csv|glsl|bash|python|cmake|cpp)) ;;
      README.md:@(console|yaml) | docs/+([^/]).md:@(console|yaml)) console=yes ;;
      *) fail "$page:$number: blocks of this page may not have the language '$language'"; language=other ;;
    esac
  done <"$page"
  [[ -z $language ]] || fail "$page: a block is not closed"
done < <(find . -name '*.md' -not -path './build/*' -not -path './out/*' -not -path './.git/*' | sed 's|^\./||' | sort)

for row in "${!reasons[@]}"; do
  [[ -v seen[$row] ]] || fail "tests/docs/not_run.txt names a block that is not there: $row"
done
exit "$status"
