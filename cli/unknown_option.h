#pragma once
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// Of some arguments the first that looks like an option and is none of `known`; empty where there is none.
/// `known` are spelled with their dashes. The value behind `=` belongs to no name.
std::string first_unknown_option(std::span<const std::string> arguments, std::span<const std::string> known);

/// The known name that takes the fewest changed letters to spell, if these are few enough to be a slip; otherwise
/// empty.
std::string likeliest_name(const std::string& name, std::span<const std::string> known);

}  // namespace trueshade
