#pragma once
#include <string>

#include "cli/command_tables.h"

namespace trueshade {

/// Manual pages in man(7)'s macros, of section 1: `trueshade.1` and `trueshade-COMMAND.1`. Without dates, so that the
/// same tables give the same bytes.
std::string man_page_of_program(const CommandTables& tables);
std::string man_page_of_command(const CommandTable& table);

}  // namespace trueshade
