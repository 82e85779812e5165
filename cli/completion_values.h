#pragma once
#include <string>
#include <vector>

#include "cli/option_table.h"

namespace trueshade {

/// What a shell offers for a value.
enum class Offer : uint8_t { nothing, names, list_of_names, files, folders, scenes };
Offer offer_of(const OptionRow& row);

/// `builtin:city` and so on.
std::vector<std::string> scene_names();
std::string with_spaces(const std::vector<std::string>& words);
/// In single quotes, as sh, bash and zsh read them.
std::string single_quoted(const std::string& text);

}  // namespace trueshade
