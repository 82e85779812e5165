#pragma once
#include <array>

namespace trueshade {

/// A corner of a submitted triangle, as normal maps read it: world position, u and v.
using MapCorner = std::array<float, 5>;

/// The directions along which u and v grow, of any length.
struct MapTangents {
  std::array<double, 3> u{}, v{};
  double side = 0.0;  ///< of vertices' tangents, which have no v: above 0: B is along N x u, below 0 against it
};

/// The tangents of a triangle, the same for every order of its corners; zero where it has no area in uv.
MapTangents tangents_of(const std::array<MapCorner, 3>& corners);

/// The normal that a texel of a normal map makes of the interpolated one (docs/arithmetic.md section 13), not made
/// unit. It is the interpolated one where that is 0 or NaN, or where u grows along it or nowhere.
std::array<float, 3> bent_normal(const MapTangents& along, const std::array<float, 3>& normal,
                                 const std::array<float, 4>& texel, float scale);

}  // namespace trueshade
