#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>

namespace trueshade {

/// Whose bits a frame has where OpenGL leaves a choice (docs/gl_rules.md section 0).
///   ideal:              our own choices: exact snapping, nearest stores, blending in float32. docs/arithmetic.md
///   mesa_llvmpipe_22_3: that driver's, on a CPU with FMA (sRGB targets: of AMD), for stores and fetches, blending, and
///                       snapping and filling of triangles wholly inside the viewport. docs/arithmetic.md section 11
///                       says what is not promised
enum class NumericProfile : uint8_t { ideal, mesa_llvmpipe_22_3 };

/// As on the command line and in JSON, in the order of the values.
inline constexpr std::string_view kProfileNames[] = {"ideal", "mesa-llvmpipe-22.3"};

/// Spelling on the command line and in JSON.
constexpr std::string_view profile_name(NumericProfile profile) { return kProfileNames[size_t(profile)]; }

/// The profile of that name, or nothing.
constexpr std::optional<NumericProfile> profile_from_name(std::string_view name) {
  for (size_t i = 0; i < std::size(kProfileNames); ++i)
    if (kProfileNames[i] == name) return NumericProfile(i);
  return std::nullopt;
}

}  // namespace trueshade
