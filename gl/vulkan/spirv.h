#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gl/emit/glsl_terms.h"

namespace trueshade::oracle {

/// Compiles GLSL for Vulkan to SPIR-V, by glslang, not optimized. Throws std::runtime_error with its log where the text
/// is wrong.
std::vector<uint32_t> spirv_of(const std::string& name, ShaderStage stage, const std::string& text);

}  // namespace trueshade::oracle
