// Reads a command line by the tables of commands. Arguments and options come in any order; `--name VALUE` and
// `--name=VALUE`, `-o VALUE` and `-oVALUE`, and `-qo VALUE` are the same as in other programs, and all behind `--` are
// arguments. A -h among switches of one letter asks for help as well.
#include <algorithm>
#include <optional>
#include <span>

#include "cli/command_tables.h"
#include "cli/help_text.h"
#include "cli/option_values.h"
#include "cli/shell_words.h"
#include "core/error.h"
#include "core/likeliest_name.h"

namespace trueshade {
namespace {

/// What was given of a row.
struct GivenRow {
  const OptionRow* row;
  std::vector<std::string> values;
};

class CommandReader {
 public:
  CommandReader(const CommandTable& table, std::span<const std::string> words) : table_(table), words_(words) {}

  /// The help that is asked for; nothing where none is. Error(usage) for a word that no row takes.
  std::optional<std::string> read() {
    bool only_arguments = false;
    for (next_ = 0; next_ < words_.size();) {
      const std::string& word = words_[next_++];
      if (!only_arguments && word == "--help") return help_of_command(table_);
      if (!only_arguments && word == "--help-limits" && table_.has_limits()) return help_of_limits(table_);
      if (only_arguments || word.size() < 2 || word[0] != '-')
        arguments_.push_back(word);
      else if (word == "--")
        only_arguments = true;
      else if (word[1] == '-')
        read_long(word);
      else
        read_short(word);
      if (asks_help_) return help_of_command(table_);
    }
    return std::nullopt;
  }

  /// Gives every row its values. Error(usage) for one argument too many, for what is missing, and for a value that its
  /// row cannot read.
  void give() {
    give_arguments();
    for (const OptionRow& row : table_.rows)
      if (row.is_required && !is_given(row))
        throw usage(row.spellings().back(), "it is required",
                    row.is_argument() ? "`" + help_command() + "` says what it is" : "add it with a value");
    for (const GivenRow& given : given_) given.row->take(given.values);
  }

 private:
  std::string help_command() const { return "trueshade " + table_.name + " --help"; }
  bool is_given(const OptionRow& row) const {
    return std::any_of(given_.begin(), given_.end(), [&row](const GivenRow& given) { return given.row == &row; });
  }

  const OptionRow& row_spelled(const std::string& name) const {
    for (const OptionRow& row : table_.rows) {
      if (row.is_argument()) continue;
      for (const std::string& spelling : row.spellings())
        if (spelling == name) return row;
    }
    throw usage(name, "there is no such option",
                did_you_mean(name, table_.option_spellings()) + "`" + help_command() + "` names all options");
  }

  void read_long(const std::string& word) {
    const size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const OptionRow& row = row_spelled(name);
    if (row.is_switch()) {
      if (equals != std::string::npos) throw usage(name, "it takes no value", "leave out what stands behind the =");
      return note(row, name, {});
    }
    note(row, name, equals == std::string::npos ? value_behind(row, name) : word.substr(equals + 1));
  }

  /// Switches of one letter, and one option with its value at the end.
  void read_short(const std::string& word) {
    for (size_t at = 1; at < word.size(); ++at) {
      const std::string name = std::string("-") + word[at];
      if (name == "-h" && are_spelled(word.substr(at + 1))) return void(asks_help_ = true);
      // An unknown first letter makes the whole word the mistake: `-size` is an option with a dash too few.
      const OptionRow& row = at == 1 && (name == "-h" || !is_spelled(name))
                                 ? row_spelled(word.substr(0, word.find('=')))
                                 : row_spelled(name);
      if (row.is_switch()) {
        if (word.substr(at + 1).starts_with('='))
          throw usage(name, "it takes no value", "leave out what stands behind the =");
        note(row, name, {});
        continue;
      }
      std::string rest = word.substr(at + 1);
      if (rest.starts_with('=')) rest.erase(0, 1);
      return note(row, name, at + 1 < word.size() ? rest : value_behind(row, name));
    }
  }

  bool is_spelled(const std::string& name) const {
    const std::vector<std::string> all = table_.option_spellings();
    return std::find(all.begin(), all.end(), name) != all.end();
  }

  bool are_spelled(const std::string& letters) const {
    return std::all_of(letters.begin(), letters.end(), [this](char c) { return is_spelled(std::string("-") + c); });
  }

  const std::string& value_behind(const OptionRow& row, const std::string& name) {
    if (next_ == words_.size() || is_spelled(words_[next_]))
      throw usage(name, "its value is missing", "add it: " + name + ' ' + row.value_name);
    return words_[next_++];
  }

  void note(const OptionRow& row, const std::string& name, const std::string& value) {
    for (GivenRow& given : given_) {
      if (given.row != &row) continue;
      if (!row.is_switch() && !row.is_repeated) throw usage(name, "it is given twice", "give it once");
      if (!row.is_switch()) given.values.push_back(value);
      return;
    }
    given_.push_back({&row, row.is_switch() ? std::vector<std::string>{} : std::vector{value}});
  }

  void give_arguments() {
    size_t taken = 0;
    for (const OptionRow& row : table_.rows) {
      if (!row.is_argument() || taken == arguments_.size()) continue;
      const auto begin = arguments_.begin() + std::ptrdiff_t(taken);
      const auto end = row.is_repeated ? arguments_.end() : begin + 1;
      given_.push_back({&row, {begin, end}});
      taken = size_t(end - arguments_.begin());
    }
    if (taken < arguments_.size())
      throw usage("command line", "'" + arguments_[taken] + "' is one argument too many",
                  "`" + help_command() + "` names all options");
  }

  const CommandTable& table_;
  std::span<const std::string> words_;
  size_t next_ = 0;
  bool asks_help_ = false;
  std::vector<std::string> arguments_;
  std::vector<GivenRow> given_;
};

/// The table of the command that the first word names. Error(usage): there is none.
const CommandTable& named_command(const CommandTables& tables, const std::string& name) {
  if (const CommandTable* table = tables.named(name)) return *table;
  if (!name.starts_with('-'))
    throw usage("command line", "there is no command '" + name + "'",
                did_you_mean(name, tables.names()) + "one of: " + joined(tables.names()));
  constexpr std::string_view kOptions[] = {"-h", "--help", "--help-limits", "--version"};
  throw usage(name.substr(0, name.find('=')), "there is no such option",
              did_you_mean(name.substr(0, name.find('=')), kOptions) + "`trueshade --help` names all options");
}

/// `--version`, which may have `--json` beside it.
Command version_command(std::span<const std::string> words) {
  VersionOptions options;
  for (const std::string& word : words) {
    if (word != "--json")
      throw usage(word, "--version does not take it", "leave it out; --json prints the version as JSON");
    options.json = true;
  }
  return options;
}

/// What was typed, for commands that tell of it.
void set_command_line(Command& command, std::span<const std::string> words) {
  std::string line;
  for (const std::string& word : words) line += ' ' + for_shell(word);
  std::visit(
      [&line](auto& options) {
        if constexpr (requires { options.command_line; }) options.command_line = line;
      },
      command);
}

}  // namespace

void take_options(const CommandTable& table, std::span<const std::string> words) {
  CommandReader reader(table, words);
  if (reader.read()) throw usage("--help", "it is asked for among criteria", "leave it out");
  reader.give();
}

Execution execution_of(const RenderOptions& options) {
  Execution execution = options.execution;
  execution.simd = options.simd;
  return execution;
}

Command command_from_arguments(int count, const char* const* arguments) {
  const CommandTables tables;
  std::vector<std::string> words(arguments + 1, arguments + std::max(count, 1));
  if (!words.empty() && words[0] == "help") {  // `help COMMAND` is `COMMAND --help`
    words.erase(words.begin());
    words.push_back("--help");
  }
  if (words.empty()) throw usage("command line", "no command is named", "see trueshade --help");
  if (words[0] == "--help" || words[0] == "-h") return PrintText{help_of_program(tables)};
  if (words[0] == "--help-limits") return PrintText{help_of_limits(tables.all().front())};
  const std::span<const std::string> rest = std::span(words).subspan(1);
  if (words[0] == "--version") return version_command(rest);
  if (words[0] == "--json" && words.size() > 1 && words[1] == "--version") {
    std::swap(words[0], words[1]);
    return version_command(rest);
  }
  const CommandTable& table = named_command(tables, words[0]);
  CommandReader reader(table, rest);
  if (const std::optional<std::string> help = reader.read()) return PrintText{*help};
  reader.give();
  Command command = table.finished();
  set_command_line(command, words);
  return command;
}

}  // namespace trueshade
