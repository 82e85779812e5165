#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace trueshade::fuzz {

/// Reads bytes as one of the readers of a scene or a picture does. Returns where they are read or refused by an Error,
/// and ends the process where a promise about what was read is broken.
struct Target {
  std::string_view name;
  void (*run)(std::span<const uint8_t> bytes);
};
std::span<const Target> targets();

/// Null for a name that there is not.
const Target* target_named(std::string_view name);

}  // namespace trueshade::fuzz
