#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gl/emit/glsl_terms.h"

namespace trueshade::oracle {

/// GLSL in Vulkan's terms as SPIR-V, compiled by glslang, not optimized. Throws std::runtime_error with its log
/// where the text is wrong.
std::vector<uint32_t> spirv_of(const std::string& name, ShaderStage stage, const std::string& text);

}  // namespace trueshade::oracle
