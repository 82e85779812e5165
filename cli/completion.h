#pragma once
#include <string>

#include "cli/command_tables.h"

namespace trueshade {

// Scripts by which shells complete commands, options, their known values and names of scenes and files.
std::string bash_completion(const CommandTables& tables);
std::string zsh_completion(const CommandTables& tables);
std::string fish_completion(const CommandTables& tables);

}  // namespace trueshade
