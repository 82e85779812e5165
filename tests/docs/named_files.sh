#!/bin/bash
# Fails on a guide that names a file which is not there, in a link or in backticks as folder/file.ending, and on a source
# that cites a guide which is not there, or a page that is not part of the repository. Also fails on a guide that
# docs/README.md does not lead to, and on a README.md with more than 15 links to pages.
# Usage: named_files.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
sources=(core scenes raster shading scene_cache bands farm explain compare view oracle judge gl cli bench tests cmake scripts)
check() {  # PAGE NAME CANDIDATES...: one of the candidates is a file or a folder
  local page=$1 name=$2 candidate
  shift 2
  for candidate in "$@"; do [[ ! -e $candidate ]] || return 0; done
  echo "$page: there is no $name"
  status=1
}
while IFS= read -r page; do
  folder=$(dirname "$page")
  while IFS= read -r target; do
    check "$page" "$target" "$folder/$target"
  done < <(grep -oE '\]\([^)#:]+[)#]' "$page" | sed -E 's/^\]\((.*)[)#]$/\1/' | sort -u)
  while IFS= read -r name; do
    check "$page" "$name" "$name" "$folder/$name"
  done < <(grep -v '^!\[' "$page" | grep -oE '`[a-z_]+/[A-Za-z0-9_./-]+\.(h|cpp|md|sh|txt|cmake|json|py)`' | tr -d '`' | sort -u)
done < <(find . -name '*.md' -not -path './build/*' -not -path './out/*' -not -path './.git/*' -not -path './docs/journal/*' | sort)
for guide in docs/*.md; do
  name=${guide#docs/}
  [[ $name != README.md ]] || continue
  grep -qF "]($name)" docs/README.md || { echo "docs/README.md does not name $guide"; status=1; }
done
links=$(grep -oE '\]\([^)#:]+\.md' README.md | sort -u | wc -l)
((links <= 15)) || { echo "README.md leads to $links pages, of which nobody knows where to begin: docs/README.md has them"; status=1; }
while IFS=: read -r file line guide; do
  check "$file:$line" "$guide" "$guide"
done < <(grep -rnoE 'docs/[A-Za-z0-9_/]+\.md' "${sources[@]}")
if grep -rnE '\b(GL_RULES|DESIGN section|DESIGN, settled|STYLE|HOUSE)\b(\.md)?' "${sources[@]}" --exclude=named_files.sh; then
  echo "docs/gl_rules.md has the rules, and the settled points in its section 10"
  status=1
fi
exit "$status"
