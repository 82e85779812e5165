#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The surfaces in a tile, bounded by what its pixels hold: a sphere around their places, and a cone around their
/// normals.
struct TileSurface {
  float low = 2, high = -1;        ///< least and greatest depth; low > high: the tile shows nothing
  std::array<double, 3> center{};  ///< world: a sphere about the tile's part of the view between those depths
  double radius = 0;
  std::array<double, 3> axis{};  ///< every normal is within acos(cosine) of it
  double cosine = -1;

  /// Whether some point of the sphere may be within `reach` (scene units) of the light.
  bool within(const glm::vec3& light, double reach) const;
  /// Whether some surface of the tile may face the light: a normal of the cone, anywhere in the sphere. With t the
  /// cone's angle and sin p = radius / distance, none does where the light is farther than 90 degrees + t + p from the
  /// axis.
  bool faces(const glm::vec3& light) const;
};

/// Bounds the surfaces of each tile; tiles in rows, the bottom row first. Roundings of float positions are covered.
///   depth:   as stored, row 0 at the bottom; those equal to clear_depth hold no surface
///   normals: RGBA halves in the same order, of any length; empty: not known
///   tile:    pixels a side
std::vector<TileSurface> tile_surfaces(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                                       std::span<const uint16_t> normals, int tile);

}  // namespace trueshade::oracle
