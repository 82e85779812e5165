#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "gl/emit/glsl_terms.h"

namespace trueshade::oracle {

/// A name of an API's headers, and what it stands for in the Khronos registry.
struct ApiNumber {
  std::string_view name;
  uint32_t number;
};

/// The names that a frame's files may hold, and those that drawing from them takes, for programs without headers.
std::span<const ApiNumber> api_numbers(ShaderApi api);

}  // namespace trueshade::oracle
