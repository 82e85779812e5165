#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What a tile shows, from what its pixels hold: where lights must be to reach it, and on which side.
struct TileSurface {
  float low = 2, high = -1;        ///< least and greatest depth; low > high: the tile shows nothing
  std::array<double, 3> center{};  ///< world: a sphere about the tile's part of the view between those depths
  double radius = 0;
  std::array<double, 3> axis{};  ///< every normal is within acos(cosine) of it
  double cosine = -1;

  /// False where nothing in the sphere is within `reach` of the light.
  bool within(const glm::vec3& light, double reach) const;
  /// False where no normal of the cone faces the light from anywhere in the sphere: with t the cone's angle and
  /// sin p = radius / distance, the light is farther than 90 degrees + t + p from the axis.
  bool faces(const glm::vec3& light) const;
};

/// Tiles in rows from the bottom. depth: as stored, row 0 at the bottom; those equal to clear_depth hold no surface.
/// normals: RGBA halves in the same order, of any length; empty: not known. Roundings of a float position are covered.
std::vector<TileSurface> tile_surfaces(const Scene& scene, const Pipeline& pipeline, std::span<const float> depth,
                                       std::span<const uint16_t> normals, int tile);

}  // namespace trueshade::oracle
