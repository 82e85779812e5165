#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trueshade {

/// The name by which a user means standard input, and how errors call it.
inline constexpr std::string_view kStandardInputName = "-";
inline constexpr std::string_view kStandardInput = "standard input";

/// All of standard input, which can be read once. Error(usage) where it has been read already or is a terminal,
/// Error(limit) over `limit` bytes, which `option` sets, or over the memory cap, Error(io) where reading fails.
std::vector<uint8_t> read_standard_input(uint64_t limit, std::string_view option);

}  // namespace trueshade
