#pragma once
#include <cstdint>
#include <string_view>

namespace trueshade::programs {

/// How many tokens of GLSL a text has once its macros are expanded, each expansion counted as one besides: at most, for
/// whatever conditions (#if) hold, up to kEndlessGrowth. Names that ## makes are not followed.
inline constexpr uint64_t kEndlessGrowth = uint64_t(1) << 40;
uint64_t tokens_with_macros(std::string_view text);

}  // namespace trueshade::programs
