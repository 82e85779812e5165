#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "programs/values/program_limits.h"
#include "scenes/scene_limits.h"

namespace trueshade {

/// Limits that options set, and where scenes are kept that were read.
struct Limits : SceneLimits {
  uint64_t memory = 0;                                       ///< bytes; 0: as memory_cap() has it
  uint64_t pixels = 0;                                       ///< of a picture that is drawn or read; 0: any
  uint64_t seconds = 0;                                      ///< of the whole run; 0: any
  uint64_t program_nodes = programs::ProgramLimits{}.nodes;  ///< of a light program
  uint64_t loop_trips = programs::ProgramLimits{}.trips;
  uint64_t program_seconds = programs::ProgramLimits{}.seconds;
  std::optional<std::string> cache;  ///< folder of cache files of scenes (scene_cache/)
};

/// An option of the group `Limits`.
struct LimitOption {
  const char* name;
  enum class Unit : uint8_t { count, bytes, seconds } unit;
  uint64_t Limits::*limit;
  const char* help;
};
std::span<const LimitOption> limit_options();

/// What the help calls a value of the option.
const char* value_name(const LimitOption& option);

/// What the help says of an option, with its default.
std::string help_of(const LimitOption& option);

/// Reads the value of an option: a whole number above 0, and of bytes with K, M, G or T behind it for powers of 1024.
/// Error(usage) naming the option.
uint64_t limit_from_text(const LimitOption& option, const std::string& text);

}  // namespace trueshade
