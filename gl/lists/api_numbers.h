#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gl/emit/glsl_terms.h"
#include "scenes/texture.h"

namespace trueshade::oracle {

/// A name of an API's headers, and what it stands for in the Khronos registry.
struct ApiNumber {
  std::string_view name;
  uint32_t number;
};

/// The names that a frame's files may hold, and those that drawing from them takes, for programs without headers.
std::span<const ApiNumber> api_numbers(ShaderApi api);
/// The number of one of these names.
uint32_t api_number(ShaderApi api, std::string_view name);

/// What an API calls a wrap: GL_REPEAT, VK_SAMPLER_ADDRESS_MODE_REPEAT.
std::string wrap_name(ShaderApi api, Wrap wrap);
/// A word of ours as the APIs spell it: CLAMP_TO_EDGE.
std::string capitals(std::string_view word);

}  // namespace trueshade::oracle
