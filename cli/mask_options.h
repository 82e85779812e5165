#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/option_table.h"
#include "compare/picture_mask.h"

namespace trueshade {

/// The rows --mask, --ignore and --allow-mask, under a heading of their own.
void add_mask(CommandTable& table, compare::MaskRules& rules);

/// Error(usage) for leave to leave out much where nothing is left out.
void check_mask(const compare::MaskRules& rules);

}  // namespace trueshade
