#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "programs/values/program.h"
#include "programs/values/program_limits.h"

namespace trueshade::programs {

/// What glslang makes of a light program: the prelude programs/light_interface.glsl, the user's text and an entry point
/// of ours, which has the defaults of what the text does not define.
struct CompiledLight {
  std::vector<uint32_t> words;  ///< SPIR-V 1.3 by no optimiser
  bool defines_reaches = false, defines_start = false, defines_finish = false;
};

/// Error(bad_input) `FILE:LINE: reason`, or `FILE:LINE:COLUMN: reason` where the place in the line is known, with the
/// lines of the user's text.
CompiledLight compiled_light(const std::string& file, const std::string& text,
                             const ProgramLimits& limits = program_limits());

/// A program from GLSL.
Program program_from_glsl(const std::string& file, const std::string& text,
                          const ProgramLimits& limits = program_limits());

/// A program from SPIR-V that has the blocks of compiled_light() by name, made by any compiler. Hostile words end in an
/// Error.
Program program_from_spirv(const std::string& file, std::vector<uint32_t> words,
                           const ProgramLimits& limits = program_limits());

/// The program of a text, GLSL or SPIR-V, compiled once a process. Error(usage) of an empty text.
std::shared_ptr<const Program> kept_program(const std::string& file, const std::string& text);

}  // namespace trueshade::programs
