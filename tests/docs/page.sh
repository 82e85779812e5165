#!/bin/bash
# Runs what a page of the guides shows, in the page's order, in a scratch folder. The blocks of a page, by language:
#   sh      commands, a line each (a backslash at a line's end goes on); `# exit 3` states another exit code than 0
#   text    after sh: lines that the commands before print, in this order; `...` stands for any text
#   sh python   commands that need the Python module, which tests/docs/python_page.py runs in ./check python: left out
#   json    a scene or a pipeline, which is drawn, or jobs, which are not run; ply, csv, cpp, glsl, python, bash: a file. Each is written under the name in `backticks`
#           that the line before the block gives last; a json without a name gets one, a cpp is left out.
# The cpp blocks of pages with a cmake block are built by tests/consumer/run.sh. What tests/docs/tags.sh lets pass besides is
# not run.
# The scratch folder starts with the files of tests/docs/files. Usage: page.sh COMMAND SOURCE_FOLDER PAGE
set -euo pipefail
export LC_ALL=C.UTF-8 TZ=UTC
command=$(realpath "$1")
source_folder=$(realpath "$2")
page=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/page"
ln -s "$command" "$work/bin/trueshade"
cp -r "$source_folder/tests/docs/files/." "$work/page"
export PATH="$work/bin:$PATH"
printed=$work/printed
: >"$printed"
failures=0 commands=0 without_driver=0 last_block_ran=yes

fail() {  # LINE WHAT: says what is wrong with the page, and goes on with it
  printf '%s:%s: %s\n' "$page" "$1" "$2"
  failures=$((failures + 1))
}

# run_line LINE COMMAND: one command of an sh block; its output is added to $printed.
run_line() {
  local expected=0 code=0
  [[ $2 =~ \#.*exit\ ([0-9]+) ]] && expected=${BASH_REMATCH[1]}
  (cd "$work/page" && timeout 120 bash -c "$2") >"$work/output" 2>&1 </dev/null || code=$?
  cat "$work/output" >>"$printed"
  commands=$((commands + 1))
  if ((code == 7 && expected != 7)); then
    without_driver=$((without_driver + 1)) last_block_ran=no
  elif ((code != expected)); then
    fail "$1" "exit $code, not $expected: $2"
    cat "$work/output"
  fi
}

# run_commands FIRST_LINE LINES...: an sh block.
run_commands() {
  local number=$1 line whole=
  shift
  : >"$printed"
  last_block_ran=yes
  for line in "$@"; do
    whole+=$line
    if [[ $line == *\\ ]]; then
      whole=${whole%\\}
    else
      [[ -z ${whole// /} || $whole == \#* ]] || run_line "$number" "$whole"
      whole=
    fi
    number=$((number + 1))
  done
}

# matches TEXT PATTERN: whether they are equal where `...` of the pattern stands for any text.
matches() {
  local rest=$1 pattern=$2 piece
  [[ $pattern == *...* ]] || { [[ $rest == "$pattern" ]]; return; }
  piece=${pattern%%...*} pattern=${pattern#*...}
  [[ $rest == "$piece"* ]] || return 1
  rest=${rest#"$piece"}
  while [[ $pattern == *...* ]]; do
    piece=${pattern%%...*} pattern=${pattern#*...}
    [[ $rest == *"$piece"* ]] || return 1
    rest=${rest#*"$piece"}
  done
  [[ $rest == *"$pattern" ]]
}

# expect_output FIRST_LINE LINES...: a text block, held against what the sh block before it printed.
expect_output() {
  local number=$1 line i=0 output
  shift
  [[ $last_block_ran == yes ]] || return 0
  mapfile -t output <"$printed"
  for line in "$@"; do
    while ((i < ${#output[@]})) && ! matches "${output[i]}" "$line"; do i=$((i + 1)); done
    if ((i == ${#output[@]})); then
      fail "$number" "the commands before do not print: $line"
      cat "$printed"
      return
    fi
    i=$((i + 1)) number=$((number + 1))
  done
}

# write_file FIRST_LINE ENDING LINE_BEFORE LINES...: a file's block. A scene or a pipeline is drawn, too.
write_file() {
  local number=$1 ending=$2 before=$3 name=
  shift 3
  while [[ $before =~ \`([A-Za-z0-9_./-]+\.$ending)\`(.*) ]]; do
    name=${BASH_REMATCH[1]} before=${BASH_REMATCH[2]}
  done
  if [[ -z $name ]]; then
    [[ $ending != cpp ]] || return 0
    [[ $ending == json ]] || { fail "$number" "the line before the block names no file that ends in .$ending"; return; }
    name=line_$number.json
  fi
  mkdir -p "$(dirname "$work/page/$name")"
  printf '%s\n' "$@" >"$work/page/$name"
  if [[ $ending == json && $* == *'"version"'* && $* =~ \"(objects|lights|camera)\" ]]; then
    run_line "$number" "trueshade render $name --size 32x32 --hash"
  elif [[ $ending == json && $* != *'"jobs"'* ]]; then
    run_line "$number" "trueshade render builtin:cornell --size 32x32 --pipeline $name --hash"
  fi
}

number=0 language= before= before_language= block=() first=0
while IFS= read -r line || [[ -n $line ]]; do
  number=$((number + 1))
  if [[ -z $language && $line == '```'* ]]; then
    language=${line#'```'} block=() first=$((number + 1))
  elif [[ -z $language ]]; then
    [[ -z ${line// /} ]] || before=$line
  elif [[ $line != '```' ]]; then
    block+=("$line")
  else
    case $language in
      sh) run_commands "$first" "${block[@]}" ;;
      text) [[ $before_language != sh ]] || expect_output "$first" "${block[@]}" ;;
      json | ply | csv | cpp | glsl) write_file "$first" "$language" "$before" "${block[@]}" ;;
      bash) write_file "$first" sh "$before" "${block[@]}" ;;
      python) write_file "$first" py "$before" "${block[@]}" ;;
    esac
    before_language=$language language=
  fi
done <"$source_folder/$page"

echo "$page: $commands commands ran, $failures of what the page says is not so"
((failures == 0)) || exit 1
((without_driver == 0)) || echo "SKIPPED: $without_driver commands need an OpenGL driver; all others ran"
