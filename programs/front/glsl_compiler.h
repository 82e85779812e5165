#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "programs/values/program_limits.h"

namespace trueshade::programs {

/// The SPIR-V of a compute shader for Vulkan 1.1, with names and lines, by no optimiser. The prelude stands before
/// `text`, `before` between them, and `tail` behind; lines are those of `text`. keep_uncalled: functions that main does
/// not call stay. Error(bad_input) with the first error and its line; Error(limit).
std::vector<uint32_t> spirv_of_glsl(const std::string& file, const std::string& text, const std::string& tail,
                                    bool keep_uncalled, const std::string& before, const ProgramLimits& limits);

}  // namespace trueshade::programs
