#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/command_tables.h"

namespace trueshade {

std::string help_of_program(const CommandTables& tables);  ///< `trueshade --help`
std::string help_of_command(const CommandTable& table);    ///< `trueshade COMMAND --help`
std::string help_of_limits(const CommandTable& table);     ///< `trueshade COMMAND --help-limits`

// What help and man pages say alike.

/// `trueshade render [OPTIONS] SCENE`
std::string usage_line(const CommandTable& table);
/// `-o,--output FILE`, of an argument its name.
std::string row_heading(const OptionRow& row);
/// The exit codes and what they mean, of all commands.
const std::vector<std::pair<int, std::string_view>>& exit_codes();
/// Variables of the environment that the command reads, and what they change.
const std::vector<std::pair<std::string_view, std::string_view>>& environment();
extern const char* const kAboutProgram;
extern const char* const kHelpLimitsAbout;  ///< what --help-limits prints

}  // namespace trueshade
