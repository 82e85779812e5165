#!/bin/bash
# Fails where the newest section of CHANGELOG.md is not of the version that CMake builds, where it is silent about a golden
# frame whose hash is no longer that of the last release, or speaks of a change where there is none, and where a guide
# shows another version. Usage: changelog.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
fail() {
  printf '%s\n' "$1"
  status=1
}

version=$(sed -nE 's/^project\(trueshade VERSION ([0-9.]+) .*/\1/p' CMakeLists.txt)
section=$(awk '/^## / { ++seen } seen == 1' CHANGELOG.md)
[[ $section == "## $version"* ]] || fail "CHANGELOG.md begins with '${section%%$'\n'*}', and CMake builds version $version"

changed=$(scripts/changed_pictures.sh)
if [[ -z $changed ]]; then
  grep -q '^\*\*Pictures changed: no\.\*\*' <<<"$section" || fail "CHANGELOG.md does not say **Pictures changed: no.**, and none has"
else
  grep -q '^\*\*Pictures changed: yes\.\*\*' <<<"$section" || fail "CHANGELOG.md does not say **Pictures changed: yes.**"
  while read -r scene preset size old new; do
    grep -qE "$scene.*$preset.*$size.*${old:0:12}.*${new:0:12}" <<<"$section" ||
      fail "CHANGELOG.md does not say that $scene under $preset, $size, went from ${old:0:12} to ${new:0:12}"
  done <<<"$changed"
fi

while IFS= read -r shown; do
  [[ $shown == *[!0-9.]"$version" ]] || fail "$shown is not of version $version"
done < <(grep -noE '(trueshade[ _-]v?|ref: v|trueshade@v)[0-9]+\.[0-9]+\.[0-9]+' README.md docs/*.md | sort -u)
exit "$status"
