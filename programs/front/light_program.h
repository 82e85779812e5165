#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "programs/values/program.h"

namespace trueshade::programs {

/// How much a program may ask for; above it Error(limit).
struct ProgramLimits {
  size_t nodes = 100'000;     ///< of the program
  size_t trips = 1'024;       ///< of a loop
  size_t words = 1'000'000;   ///< of SPIR-V
  size_t source = 1'000'000;  ///< bytes of GLSL
};

/// The SPIR-V of a light program in GLSL: the prelude programs/light_interface.glsl, the user's text, and an entry point
/// of ours. Error(bad_input) `FILE:LINE: reason`, `FILE:LINE:COLUMN: reason` where the place in the line is known.
std::vector<uint32_t> spirv_from_glsl(const std::string& file, const std::string& text, const ProgramLimits& limits);

/// Which of the functions that have a default the user's text defines.
struct DefinedFunctions {
  bool reaches = false, start = false, finish = false;
};

/// A program from GLSL.
Program program_from_glsl(const std::string& file, const std::string& text, const ProgramLimits& limits = {});

/// A program from SPIR-V with the blocks of docs/light_programs.md, by any compiler. Hostile words end in an Error.
Program program_from_spirv(const std::string& file, std::vector<uint32_t> words, const ProgramLimits& limits = {});

}  // namespace trueshade::programs
