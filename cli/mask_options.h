#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/option_table.h"
#include "cli/option_texts.h"
#include "compare/picture_mask.h"

namespace trueshade {

/// The rows --mask, --ignore and --allow-mask, under a heading of their own.
void add_mask(CommandTable& table, MaskTexts& texts);

/// Error(usage) for what is no plane of identifiers and no list of numbers.
compare::MaskRules mask_rules_of(const MaskTexts& texts);

}  // namespace trueshade
