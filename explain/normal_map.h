#pragma once
#include <array>

namespace trueshade {

/// One corner of a submitted triangle, as normal mapping needs it: world position x, y, z, then u, v.
using MapCorner = std::array<float, 5>;

/// The directions along which a surface's u and v grow, in world space, of any length.
struct MapTangents {
  std::array<double, 3> u{}, v{};
  double side = 0.0;  ///< 0, or where u is the vertices' tangent, without v: above 0 B points along N x u, below 0
                      ///< against it
};

/// The directions for a triangle; the same bits for every order of its corners. Both 0 where its uv has no area.
MapTangents tangents_of(const std::array<MapCorner, 3>& corners);

/// The interpolated normal as a texel of a normal map bends it (docs/arithmetic.md section 13), not made unit length.
/// It is `normal` unchanged where that is 0 or NaN, or where u grows along it or nowhere.
///   scale: factor of the texel's x and y
std::array<float, 3> bent_normal(const MapTangents& along, const std::array<float, 3>& normal,
                                 const std::array<float, 4>& texel, float scale);

}  // namespace trueshade
