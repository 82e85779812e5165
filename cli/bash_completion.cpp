#include "cli/completion.h"
#include "cli/completion_values.h"

namespace trueshade {
namespace {

/// What is the same for every table. bash takes : and = for ends of words, so the word is taken from the line, and what
/// stands before the last of them is cut from the replies.
constexpr const char* kFunctions = R"sh(
_trueshade_reply() {  # PREFIX PART NAMES: the names that begin with PART, behind PREFIX
  local name
  for name in $3; do
    [[ $name == "$2"* ]] && COMPREPLY+=("${1}${name}")
  done
}

_trueshade_files() {  # f or d, PREFIX PART
  local name
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do COMPREPLY+=("${2}${name}"); done < <(compgen "-$1" -- "$3")
}

_trueshade_offer() {  # PREFIX PART: by $offer and $names
  case $offer in
    names) _trueshade_reply "$1" "$2" "$names" ;;
    list)
      local before=
      [[ $2 == *,* ]] && before=${2%,*},
      compopt -o nospace 2>/dev/null
      _trueshade_reply "$1$before" "${2##*,}" "$names"
      ;;
    files) _trueshade_files f "$1" "$2" ;;
    folders) _trueshade_files d "$1" "$2" ;;
    scenes)
      _trueshade_reply "$1" "$2" "$_trueshade_scenes"
      ((${#COMPREPLY[@]} > 0)) && [[ -n $2 ]] || _trueshade_files f "$1" "$2"
      ;;
  esac
}

_trueshade() {
  COMPREPLY=()
  local line=${COMP_LINE:0:COMP_POINT} offer= names= options= arguments= cut= part
  local word=${line##*[[:space:]]}
  local -a words
  read -ra words <<<"${line%"$word"}"
  local command=${words[1]-} previous=${words[-1]-}
  if ((${#words[@]} < 2)); then
    _trueshade_reply '' "$word" "$_trueshade_commands help --help --help-limits --version"
  elif [[ $command == help ]]; then
    ((${#words[@]} > 2)) || _trueshade_reply '' "$word" "$_trueshade_commands"
  elif [[ $command == --version ]]; then
    _trueshade_reply '' "$word" --json
  elif _trueshade_table "$command"; then
    if [[ $word == --*=* ]]; then
      _trueshade_value "$command" "${word%%=*}" && _trueshade_offer "${word%%=*}=" "${word#*=}"
    elif ((${#words[@]} > 2)) && _trueshade_value "$command" "$previous"; then
      _trueshade_offer '' "$word"
    elif [[ $word == -* ]]; then
      _trueshade_reply '' "$word" "$options"
    else
      offer=$arguments
      _trueshade_offer '' "$word"
    fi
  fi
  [[ $COMP_WORDBREAKS == *:* && $word == *:* ]] && cut=${word%"${word##*:}"}
  if [[ $COMP_WORDBREAKS == *=* && $word == *=* ]]; then
    part=${word%"${word##*=}"}
    ((${#part} > ${#cut})) && cut=$part
  fi
  COMPREPLY=("${COMPREPLY[@]#"$cut"}")
}

complete -F _trueshade trueshade
)sh";

const char* word_of(Offer offer) {
  switch (offer) {
    case Offer::names:
      return "names";
    case Offer::list_of_names:
      return "list";
    case Offer::files:
      return "files";
    case Offer::folders:
      return "folders";
    case Offer::scenes:
      return "scenes";
    case Offer::nothing:
      break;
  }
  return "nothing";
}

/// Sets $options, and $arguments to what its first argument is.
std::string table_case(const CommandTable& table) {
  std::string argument = "nothing";
  for (const OptionRow& row : table.rows)
    if (row.is_argument()) {
      argument = word_of(offer_of(row));
      if (offer_of(row) == Offer::names) argument += " names=" + single_quoted(with_spaces(row.known_values));
      break;
    }
  return "    " + table.name + ") options=" + single_quoted(with_spaces(table.option_spellings())) +
         " arguments=" + argument + " ;;\n";
}

std::string value_cases(const CommandTable& table) {
  std::string text;
  for (const OptionRow& row : table.rows) {
    if (row.is_argument() || row.is_switch()) continue;
    std::string patterns;
    for (const std::string& name : row.spellings())
      patterns += (patterns.empty() ? "" : " | ") + single_quoted(table.name + ' ' + name);
    text += "    " + patterns + ") offer=" + word_of(offer_of(row));
    if (!row.known_values.empty()) text += " names=" + single_quoted(with_spaces(row.known_values));
    text += " ;;\n";
  }
  return text;
}

}  // namespace

std::string bash_completion(const CommandTables& tables) {
  std::string text = "# Completions of trueshade for bash, made by `trueshade completion bash`.\n_trueshade_commands=" +
                     single_quoted(with_spaces(tables.names())) +
                     "\n_trueshade_scenes=" + single_quoted(with_spaces(scene_names())) +
                     "\n\n_trueshade_table() {  # COMMAND: sets $options and $arguments\n  case $1 in\n";
  for (const CommandTable& table : tables.all()) text += table_case(table);
  text +=
      "    *) return 1 ;;\n  esac\n}\n\n_trueshade_value() {  # COMMAND OPTION: sets $offer; fails for a switch\n"
      "  case \"$1 $2\" in\n";
  for (const CommandTable& table : tables.all()) text += value_cases(table);
  return text + "    *) return 1 ;;\n  esac\n}\n" + kFunctions;
}

}  // namespace trueshade
