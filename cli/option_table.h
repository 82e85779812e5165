#pragma once
// What a command takes, as rows. Reading a command line, --help, man pages and completions are all made of these.
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/options.h"

namespace trueshade {

/// An option or an argument of a command.
struct OptionRow {
  std::string names;                        ///< `-o,--output`; of an argument the name that help gives it, `SCENE`
  std::string value_name;                   ///< what help calls a value, as FILE; empty: a switch, which takes none
  std::string help;                         ///< without a full stop at the end
  std::string group{};                      ///< the heading that it stands under; empty: the table's open one
  std::vector<std::string> known_values{};  ///< what completions offer; empty: files, folders or scenes by value_name
  bool is_list = false;                     ///< a value is several known ones with commas between
  bool is_required = false;                 ///< of arguments and options
  bool is_repeated = false;
  std::function<void(const std::vector<std::string>&)> take{};  ///< receives the values as text; of a switch none

  bool is_switch() const { return value_name.empty(); }
  bool is_argument() const { return !names.starts_with('-'); }
  std::vector<std::string> spellings() const;  ///< `-o` and `--output`, or the name of an argument
};

/// A call that a man page shows.
struct CommandExample {
  std::string command, about;
};

/// A command: its rows in the order of help.
struct CommandTable {
  std::string name, about;  ///< `about` is one line
  std::vector<OptionRow> rows{};
  std::string details{};  ///< what help says last; may be empty
  std::vector<CommandExample> examples{};
  std::vector<std::string> see_also{};  ///< names of other commands
  std::function<Command()> finished{};  ///< what the rows' values come to, once they are taken. Error(usage).
  std::string open_group = "Options";   ///< the heading of rows that are added next

  OptionRow& add(OptionRow row);
  std::vector<std::string> groups() const;  ///< the headings of options, in order
  bool has_limits() const;
  std::vector<std::string> option_spellings() const;  ///< of all options, with their dashes
};

/// Adds an option of one value. `names` and the other words as in OptionRow.
template <typename Text>
OptionRow& add_value(CommandTable& table, const char* names, const char* value_name, Text& text, std::string help) {
  OptionRow row{.names = names, .value_name = value_name, .help = std::move(help)};
  row.take = [&text](const std::vector<std::string>& given) { text = given.back(); };
  return table.add(std::move(row));
}

/// Adds an option of one value, which the function `read` makes of the option's text. `read` throws Error(usage) where
/// the text means nothing.
template <typename Value, typename Read>
OptionRow& add_read(CommandTable& table, const char* names, const char* value_name, Value& value, Read read,
                    std::string help) {
  OptionRow row{.names = names, .value_name = value_name, .help = std::move(help)};
  row.take = [&value, read](const std::vector<std::string>& given) { value = read(given.back()); };
  return table.add(std::move(row));
}

/// The same of one that may be repeated.
OptionRow& add_values(CommandTable& table, const char* names, const char* value_name, std::vector<std::string>& texts,
                      std::string help);
OptionRow& add_switch(CommandTable& table, const char* names, bool& on, std::string help);

/// Says that the value of a row is one of some names; help that ends with a colon lists them.
template <typename Names>
OptionRow& of_names(OptionRow& row, const Names& choices) {
  if (row.help.ends_with(':'))
    for (const auto& choice : choices) row.help += ' ' + std::string(choice);
  row.known_values.assign(std::begin(choices), std::end(choices));
  return row;
}

template <typename Text, typename Names>
OptionRow& add_choice(CommandTable& table, const char* names, const char* value_name, Text& text, std::string help,
                      const Names& choices) {
  return of_names(add_value(table, names, value_name, text, std::move(help)), choices);
}

/// Gives rows of a table what words of a command line say. Error(usage) as for the command itself, and for a word that
/// is no option of the table.
void take_options(const CommandTable& table, std::span<const std::string> words);

/// Its rows are in --help-limits and in man pages, and not in --help, where they would be a third of all rows.
inline constexpr const char* kLimitsGroup = "Limits";
/// The group of limits, and what else all that read scenes have.
void add_limits(CommandTable& table, Limits& limits);
/// Whether a scene file may name any file: of commands that read the scene that the command line names.
void add_trust(CommandTable& table, Limits& limits);
/// Whether faults of a file are passed over: of commands that show a scene, and judge nothing.
void add_lenient(CommandTable& table, Limits& limits);
/// What every command has.
void add_quiet(CommandTable& table, CommonOptions& options, std::string help);

}  // namespace trueshade
