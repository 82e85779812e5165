#include "cli/completion.h"
#include "cli/completion_values.h"

namespace trueshade {
namespace {

/// Text in a specification of _arguments, in which : and brackets have a meaning.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string action_of(const OptionRow& row) {
  switch (offer_of(row)) {
    case Offer::names:
      return '(' + with_spaces(row.known_values) + ')';
    case Offer::list_of_names:
      return "_values -s , " + row.value_name + ' ' + with_spaces(row.known_values);
    case Offer::files:
      return "_files";
    case Offer::folders:
      return "_files -/";
    case Offer::scenes:
      return "_trueshade_scenes";
    case Offer::nothing:
      break;
  }
  return " ";
}

/// A row as specifications, one for each spelling.
std::string specifications(const OptionRow& row) {
  const std::string value = ':' + zsh_text(row.value_name) + ':' + action_of(row);
  if (row.is_argument())
    return ' ' + single_quoted((row.is_repeated   ? "*:"
                                : row.is_required ? ":"
                                                  : "::") +
                               zsh_text(row.names) + ':' + action_of(row));
  std::string text;
  const std::string excluded = row.is_repeated ? "*" : '(' + with_spaces(row.spellings()) + ')';
  for (const std::string& name : row.spellings()) {
    const std::string end = row.is_switch() ? "" : name.starts_with("--") ? "=" : "+";
    text +=
        ' ' + single_quoted(excluded + name + end + '[' + zsh_text(row.help) + ']' + (row.is_switch() ? "" : value));
  }
  return text;
}

}  // namespace

std::string zsh_completion(const CommandTables& tables) {
  std::string text =
      "#compdef trueshade\n# Completions of trueshade for zsh, made by `trueshade completion zsh`.\n\n"
      "_trueshade_scenes() {\n  compadd -- " +
      with_spaces(scene_names()) +
      "\n  _files\n}\n\n_trueshade() {\n  local context state state_descr line curcontext=$curcontext\n"
      "  typeset -A opt_args\n  local -a commands\n  commands=(";
  for (const CommandTable& table : tables.all())
    text += "\n    " + single_quoted(table.name + ':' + zsh_text(table.about));
  text +=
      "\n    'help:Print the options of a command')\n"
      "  _arguments -C '(- *)'{-h,--help}'[Print the commands]' '(- *)--help-limits[Print the limits]' '(- "
      "*)--version[Print the version]' "
      "'1: :->command' '*:: :->rest'\n"
      "  case $state in\n    command) _describe -t commands command commands ;;\n    rest)\n      case $words[1] in\n"
      "        help) _describe -t commands command commands ;;\n";
  for (const CommandTable& table : tables.all()) {
    text += "        " + table.name + ") _arguments -s -S '(- *)'{-h,--help}'[Print the options]'";
    if (table.has_limits()) text += " '(- *)--help-limits[Print the limits]'";
    for (const OptionRow& row : table.rows) text += " \\\n         " + specifications(row);
    text += " ;;\n";
  }
  return text + "      esac\n      ;;\n  esac\n}\n\n_trueshade \"$@\"\n";
}

}  // namespace trueshade
