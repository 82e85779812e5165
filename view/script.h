#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trueshade::viewer {

/// A word that a line of a script begins with. `form` names its arguments, each in capitals: NUMBERs of any kind are
/// SECONDS, X, Y, Z, R, G, B, STOPS, STEPS, DEGREES, PIXELS, INDEX; the others are words. The last, FILE or TEXT, takes
/// the rest of the line.
struct ScriptCommand {
  std::string_view name, form, about;
};
std::span<const ScriptCommand> script_commands();

/// One line.
struct ScriptStep {
  std::string_view command;        ///< a ScriptCommand's name
  std::vector<double> numbers;     ///< in their order
  std::vector<std::string> words;  ///< in their order; checked where they are names of ours
  int line = 0;                    ///< from 1
};

/// Reads a script: a step a line; empty lines and those that begin with # are passed over. Error(bad_input) with file
/// and line for a word that no line begins with, for arguments that are missing, too many or out of range, and for
/// names that do not exist.
std::vector<ScriptStep> script_from_text(std::string_view text, const std::string& where);

}  // namespace trueshade::viewer
