#include "cli/completion.h"
#include "cli/completion_values.h"

namespace trueshade {
namespace {

/// In single quotes, as fish reads them.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + '\'';
}

/// What is offered for a value: with -x nothing else is, with -F files too.
std::string offered(const OptionRow& row) {
  switch (offer_of(row)) {
    case Offer::names:
      return " -x -a " + fish_quoted(with_spaces(row.known_values));
    case Offer::list_of_names:
      return " -x -a " + fish_quoted("(__fish_append , " + with_spaces(row.known_values) + ')');
    case Offer::files:
      return " -r -F";
    case Offer::folders:
      return " -x -a '(__fish_complete_directories)'";
    case Offer::scenes:
      return " -r -F -a " + fish_quoted(with_spaces(scene_names()));
    case Offer::nothing:
      break;
  }
  return " -x";
}

std::string fish_row(const CommandTable& table, const OptionRow& row) {
  std::string text = "complete -c trueshade -n '__fish_seen_subcommand_from " + table.name + '\'';
  if (row.is_argument()) {
    const Offer offer = offer_of(row);
    if (offer == Offer::scenes) return text + " -F -a " + fish_quoted(with_spaces(scene_names())) + '\n';
    if (offer == Offer::names) return text + " -a " + fish_quoted(with_spaces(row.known_values)) + '\n';
    return text + (offer == Offer::nothing ? " -f\n" : " -F\n");
  }
  for (const std::string& name : row.spellings())
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return text + (row.is_switch() ? "" : offered(row)) + " -d " + fish_quoted(row.help) + '\n';
}

}  // namespace

std::string fish_completion(const CommandTables& tables) {
  std::string text =
      "# Completions of trueshade for fish, made by `trueshade completion fish`.\ncomplete -c trueshade -f\n"
      "complete -c trueshade -n __fish_use_subcommand -l version -d 'Print the version'\n"
      "complete -c trueshade -s h -l help -d 'Print the options'\n"
      "complete -c trueshade -n __fish_use_subcommand -a help -d 'Print the options of a command'\n"
      "complete -c trueshade -n '__fish_seen_subcommand_from help' -a " +
      fish_quoted(with_spaces(tables.names())) + '\n';
  for (const CommandTable& table : tables.all()) {
    text +=
        "complete -c trueshade -n __fish_use_subcommand -a " + table.name + " -d " + fish_quoted(table.about) + '\n';
    for (const OptionRow& row : table.rows) text += fish_row(table, row);
    if (table.has_limits())
      text += "complete -c trueshade -n '__fish_seen_subcommand_from " + table.name +
              "' -l help-limits -d 'Print the limits'\n";
  }
  return text;
}

}  // namespace trueshade
