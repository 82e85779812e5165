#pragma once
#include <array>

namespace trueshade {

/// A corner of a submitted triangle, as normal maps read it: world position, u and v.
using MapCorner = std::array<float, 5>;

/// The normal that a texel of a normal map makes of the interpolated one. docs/arithmetic.md section 13.
std::array<float, 3> bent_normal(const std::array<MapCorner, 3>& corners, const std::array<float, 3>& normal,
                                 const std::array<float, 4>& texel, float scale);

}  // namespace trueshade
