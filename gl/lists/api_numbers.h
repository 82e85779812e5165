#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gl/emit/glsl_terms.h"
#include "scenes/texture.h"

namespace trueshade::oracle {

/// A constant of an API's headers: its name, and its number in the Khronos registry.
struct ApiNumber {
  std::string_view name;
  uint32_t number;
};

/// The constants that a frame's files may name, and those needed to draw from them, for programs without the headers.
std::span<const ApiNumber> api_numbers(ShaderApi api);
/// The number of one of these names. Throws std::logic_error for any other name.
uint32_t api_number(ShaderApi api, std::string_view name);

/// The constant of an API for a texture wrap: GL_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT.
std::string wrap_name(ShaderApi api, Wrap wrap);
/// One of our words in the APIs' spelling: `clamp_to_edge` as CLAMP_TO_EDGE.
std::string capitals(std::string_view word);

}  // namespace trueshade::oracle
