#include "cli/help_text.h"

namespace trueshade {
namespace {

constexpr size_t kLineColumns = 100, kTextColumn = 30;

/// A text from column `first` on, in lines of whole words, the later ones indented by `indent`.
std::string wrapped(const std::string& text, size_t first, size_t indent) {
  std::string lines;
  size_t column = first;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (column + word.size() > kLineColumns && column > indent) {
      while (lines.ends_with(' ')) lines.pop_back();
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    }
    lines += word;
    column += word.size();
    if (end < text.size()) {
      const bool line_ends = text[end] == '\n';
      lines += line_ends ? '\n' + std::string(indent, ' ') : " ";
      column = line_ends ? indent : column + 1;
    }
    begin = end + 1;
  }
  return lines;
}

std::string help_row(const std::string& heading, const std::string& about) {
  std::string line = "  " + heading;
  if (line.size() + 2 > kTextColumn)
    line += '\n' + std::string(kTextColumn, ' ');
  else
    line += std::string(kTextColumn - line.size(), ' ');
  return line + wrapped(about, kTextColumn, kTextColumn) + '\n';
}

std::string help_of_group(const CommandTable& table, const std::string& group) {
  std::string text = group + ":\n";
  for (const OptionRow& row : table.rows)
    if (!row.is_argument() && row.group == group)
      text += help_row(row_heading(row), row.help + (row.is_required ? " (required)" : ""));
  return text;
}

std::string exit_code_rows() {
  std::string text = "Exit codes:\n";
  for (const auto& [code, about] : exit_codes()) text += help_row(std::to_string(code), std::string(about));
  return text;
}

}  // namespace

const char* const kAboutProgram =
    "Trueshade draws scenes of many lights on the CPU, to the same bits on every machine.";

const char* const kHelpLimitsAbout =
    "Print the limits on memory, time, pixels and files (--max-memory, --timeout, ...)";

const std::vector<std::pair<int, std::string_view>>& exit_codes() {
  static const std::vector<std::pair<int, std::string_view>> kCodes = {{0, "ok"},
                                                                       {1, "a violation or a difference was found"},
                                                                       {2, "usage"},
                                                                       {3, "bad input"},
                                                                       {4, "limit exceeded"},
                                                                       {5, "input or output failed"},
                                                                       {6, "out of memory"},
                                                                       {7, "no OpenGL driver"},
                                                                       {70, "our fault"}};
  return kCodes;
}

const std::vector<std::pair<std::string_view, std::string_view>>& environment() {
  static const std::vector<std::pair<std::string_view, std::string_view>> kVariables = {
      {"NO_COLOR", "Where it is set and not empty, the words error and note are not coloured on a terminal either"},
      {"TERM", "On a terminal called dumb nothing is coloured, and no progress is drawn"},
      {"__EGL_VENDOR_LIBRARY_DIRS, LIBGL_DRIVERS_PATH, VK_ICD_FILENAMES",
       "Read by the libraries of OpenGL and Vulkan: which drivers validate and bench can open"}};
  return kVariables;
}

std::string usage_line(const CommandTable& table) {
  std::string line = "trueshade " + table.name + " [OPTIONS]";
  for (const OptionRow& row : table.rows)
    if (row.is_argument())
      line += row.is_required ? ' ' + row.names : " [" + row.names + (row.is_repeated ? "...]" : "]");
  return line;
}

std::string row_heading(const OptionRow& row) {
  return row.is_argument() || row.is_switch() ? row.names : row.names + ' ' + row.value_name;
}

std::string help_of_program(const CommandTables& tables) {
  std::string text = std::string(kAboutProgram) + "\nUsage: trueshade COMMAND [OPTIONS]\n\nCommands:\n";
  for (const CommandTable& table : tables.all()) text += help_row(table.name, table.about);
  text += "\nOptions:\n" +
          help_row("-h,--help", "Print this; `trueshade help COMMAND` names the options of a command") +
          help_row("--help-limits", std::string(kHelpLimitsAbout) + "; most commands take them") +
          help_row("--version", "Print the version, SIMD targets and libraries; with --json as JSON") + '\n';
  return text + exit_code_rows();
}

std::string help_of_limits(const CommandTable& table) { return help_of_group(table, kLimitsGroup); }

std::string help_of_command(const CommandTable& table) {
  std::string text = wrapped(table.about, 0, 0) + "\nUsage: " + usage_line(table) + '\n';
  std::string arguments;
  for (const OptionRow& row : table.rows)
    if (row.is_argument()) arguments += help_row(row.names, row.help);
  if (!arguments.empty()) text += "\nArguments:\n" + arguments;
  for (const std::string& group : table.groups())
    if (group != kLimitsGroup) text += '\n' + help_of_group(table, group);
  text += "\nHelp:\n" + help_row("-h,--help", "Print this");
  if (table.has_limits()) text += help_row("--help-limits", kHelpLimitsAbout);
  if (!table.details.empty()) text += '\n' + wrapped(table.details, 0, 0) + '\n';
  return text;
}

}  // namespace trueshade
