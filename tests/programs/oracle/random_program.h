#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tests/programs/oracle/program_inputs.h"

namespace trueshade::testing {

/// A file that defines `light`, and perhaps `reaches`, `start` and `finish`.
struct RandomProgram {
  std::string text;
  bool has_reaches = false, has_start = false, has_finish = false;
  std::vector<ProgramInput> parameters;  ///< members of its block "Parameters" at set 0, binding 5; none: no block
};

/// The program of a seed: expressions of all types and functions of light programs, arrays, structures, matrices,
/// dynamic indices, helper functions with parameters of every direction, branches, switches, and loops that end within
/// five trips by a constant bound, however their data go. Always GLSL 4.60 that glslang takes; the same text for the
/// same seed on every machine. A quarter are operations one after the other. The bits of what is computed go into a
/// mark that light returns. One invocation runs some 1,000 instructions; of 5,000 programs 4 run more than 10,000.
/// `precise` is left out, because glslang 12.0 crashes on some programs that have it.
RandomProgram random_program(uint64_t seed);

}  // namespace trueshade::testing
