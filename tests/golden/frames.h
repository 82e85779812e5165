#pragma once
#include <string_view>

namespace trueshade {

/// What a frame hashes to. A tripwire against change, not evidence of truth: the oracle, Embree and OpenGL judge that.
/// Recorded with g++ 12.2 on AVX-512; every other compiler, target and machine must agree.
struct GoldenFrame {
  std::string_view scene, preset;
  int width, height;
  std::string_view hash;
};

inline constexpr GoldenFrame kGoldenFrames[] = {
    {"builtin:city", "many-lights", 200, 150, ""},
    {"builtin:sphere", "many-lights", 200, 150, ""},
};

}  // namespace trueshade
