#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace trueshade::testing {

/// A user's file between declarations and an entry point written from the contract of light programs a second time, so
/// that the product's own can be held to it: what it does not define is the default.
std::string whole_shader(const std::string& light_file, bool has_reaches, bool has_start, bool has_finish);

/// SPIR-V 1.3 of a compute shader, by glslang, not optimised, checked by spirv-val. Throws std::runtime_error with what
/// glslang or spirv-val says and the shader's text.
std::vector<uint32_t> compiled_shader(const std::string& shader);

}  // namespace trueshade::testing
