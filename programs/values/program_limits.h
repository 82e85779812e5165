#pragma once
#include <cstddef>
#include <cstdint>

namespace trueshade::programs {

/// How much a program may ask for; above it Error(limit).
struct ProgramLimits {
  size_t nodes = 100'000;     ///< of the program
  size_t trips = 1'024;       ///< of a loop
  size_t words = 1'000'000;   ///< of SPIR-V
  size_t source = 1'000'000;  ///< bytes of GLSL
  size_t tokens = 200'000;    ///< of GLSL, its macros expanded
  uint64_t seconds = 20;      ///< of glslang, and of unrolling
  /// Bytes that glslang may take, which then runs in a process of its own, as the only way to end it; 0: any, in this
  /// process.
  uint64_t memory = uint64_t(256) << 20;
};

/// Those of the process, which hold where a caller gives no others. At most 2^26 nodes, and three years.
ProgramLimits program_limits();
void set_program_limits(const ProgramLimits& limits);

}  // namespace trueshade::programs
