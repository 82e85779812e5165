#!/bin/bash
# Completes command lines as bash, zsh and fish do, by the scripts that the command prints, and reads the manual pages as
# man and mandoc do. Shells and readers that are not installed are passed over, and said so. Usage: completions.sh COMMAND
set -euo pipefail
trueshade=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir -p scenes && touch scenes/room.json scenes/roof.glb picture.png
status=0

# expect SHELL LINE WORDS FOUND: FOUND has to be the same words.
expect() {
  local wanted found
  wanted=$(tr ' ' '\n' <<<"$3" | sort) found=$(tr ' ' '\n' <<<"$4" | sort)
  [[ $wanted == "$found" ]] && return
  printf '%s: "%s" is completed to:\n%s\nand not to:\n%s\n' "$1" "$2" "$found" "$wanted"
  status=1
}

# bash_words LINE: what bash would put in place of the last word.
"$trueshade" completion bash >trueshade.bash
cat >by_bash.sh <<'BASH'
source ./trueshade.bash
[[ $(complete -p trueshade) == *"-F _trueshade trueshade" ]] || exit 1
COMP_WORDBREAKS=$' \t\n"\'><=;|&(:' COMP_LINE=$1 COMP_POINT=${#1}
_trueshade
echo "${COMPREPLY[*]}"
BASH
bash_words() { bash --norc --noprofile by_bash.sh "$1"; }
expect bash 'render' "render" "$(bash_words 'trueshade ren')"
expect bash 'e' "export explain" "$(bash_words 'trueshade e')"
expect bash 'help s' "shade" "$(bash_words 'trueshade help s')"
expect bash '--version' "--json" "$(bash_words 'trueshade --version ')"
expect bash 'a preset' "many-lights" "$(bash_words 'trueshade render builtin:city --preset m')"
expect bash 'behind =' "many-lights" "$(bash_words 'trueshade render builtin:city --preset=m')"
expect bash 'a view' "light-count light-tile light-boxes light-edges" "$(bash_words 'trueshade render x.json --view light-')"
expect bash 'options' "--preset --pipeline --profile" "$(bash_words 'trueshade render --p')"
expect bash 'a list' "depth,position" "$(bash_words 'trueshade render --aov depth,po')"
expect bash 'a scene behind its colon' "city cornell circle" "$(bash_words 'trueshade render builtin:c')"
expect bash 'a file' "scenes" "$(bash_words 'trueshade render sce')"
expect bash 'a file in a folder' "scenes/room.json scenes/roof.glb" "$(bash_words 'trueshade render scenes/ro')"
expect bash 'an output' "picture.png" "$(bash_words 'trueshade render builtin:city -o pic')"
expect bash 'a list' "presets" "$(bash_words 'trueshade list pres')"
expect bash 'a limit' "--max-memory" "$(bash_words 'trueshade render --max-me')"
expect bash 'limits' "--help --help-limits" "$(bash_words 'trueshade render --hel')"
expect bash 'a shell' "bash" "$(bash_words 'trueshade completion b')"
expect bash 'behind a switch' "--hash" "$(bash_words 'trueshade render builtin:city -q --ha')"
expect bash 'no such command' "" "$(bash_words 'trueshade paint --p')"
expect bash 'a number' "" "$(bash_words 'trueshade render --time ')"

"$trueshade" completion zsh >_trueshade
if command -v zsh >/dev/null; then
  zsh -n _trueshade || status=1
  # A terminal in which zsh completes: what it shows between two marks is read.
  zsh -f >zsh.out 2>zsh.err <<'ZSH' || status=1
zmodload zsh/zpty
export TERM=dumb
zpty z zsh -f -i
zpty -w z 'PROMPT= RPROMPT=; stty -echo; unsetopt zle_bracketed_paste; fpath=($PWD $fpath); autoload -U compinit; compinit -u -D; LISTMAX=1000; zstyle ":completion:*" list-colors ""; echo REA""DY'
zpty -r z line '*READY*'
zpty -w -n z $'trueshade render builtin:city --preset light-volumes-\t --view spec\t --ha\t\n'
zpty -w z 'echo DO""NE'
zpty -r z line '*DONE*'
print -r -- "$line"
ZSH
  grep -q -e '--preset light-volumes-literal' zsh.out && grep -q -e '--view specular' zsh.out && grep -q -e '--hash' zsh.out ||
    { echo "zsh does not complete:"; cat zsh.out zsh.err; status=1; }
else
  echo "zsh is not installed: passed over"
fi

"$trueshade" completion fish >trueshade.fish
if command -v fish >/dev/null; then
  export HOME=$work
  # fish 4 also offers what has the typed letters further in.
  fish_words() { fish --no-config -c "source trueshade.fish; complete -C '$1'" | cut -f1 | awk -v typed="${1##* }" 'index($0, typed) == 1' | xargs; }
  expect fish 'render' "render" "$(fish_words 'trueshade ren')"
  expect fish 'a preset' "many-lights" "$(fish_words 'trueshade render builtin:city --preset m')"
  expect fish 'a list' "depth,position" "$(fish_words 'trueshade render --aov depth,po')"
  expect fish 'a scene' "builtin:city builtin:cornell builtin:circle" "$(fish_words 'trueshade render builtin:c')"
  expect fish 'options' "--preset --pipeline --profile" "$(fish_words 'trueshade render --p')"
  expect fish 'a shell' "fish" "$(fish_words 'trueshade completion f')"
else
  echo "fish is not installed: passed over"
fi

"$trueshade" man --quiet man1
commands=$("$trueshade" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\+\) .*/\1/p')
for command in $commands; do
  page=man1/trueshade-$command.1
  [[ -s $page ]] || { echo "there is no page of $command"; status=1; continue; }
  # Every option of the help, and of that of limits, is in the page, and the other way round.
  options=$({ "$trueshade" "$command" --help; "$trueshade" "$command" --help-limits 2>/dev/null || true; } | grep -oE '^  (-[a-z],)?--[a-z-]+' | grep -oE '\-\-[a-z-]+' | sort)
  described=$(grep -A1 '^\.TP' "$page" | sed 's/\\-/-/g' | grep -oE '^\\fB.*' | grep -oE '\-\-[a-z-]+' | sort)
  expect man "$command" "$options" "$described"
done
for page in man1/*.1; do
  if command -v mandoc >/dev/null; then
    said=$(mandoc -T lint -W warning "$page" | grep -v 'missing date' || true)  # newer ones ask for a date
    [[ -z $said ]] || { echo "$said"; status=1; }
  fi
  if command -v groff >/dev/null || man --version >/dev/null 2>&1; then
    said=$(MANWIDTH=160 man --warnings -l "$page" 2>&1 >/dev/null || true)
    [[ -z $said ]] || { echo "$page: $said"; status=1; }
  fi
done
exit "$status"
