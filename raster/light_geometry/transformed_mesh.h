#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "raster/region.h"
#include "raster/tile.h"
#include "raster/view.h"
#include "scenes/light.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade {

/// Vertices of one light's mesh, from object to window.
struct TransformedMesh {
  std::vector<glm::vec3> world;
  std::vector<float> clip[4];
  std::vector<int32_t> x, y;  ///< window, relative to an origin; mean nothing where the vertex needs clipping
  std::vector<double> z;
  std::vector<int32_t> needs_clip;
  bool any_needs_clip = false;
};

/// The mesh of a light, its vertices in the window relative to a sample: `origin_fx`, in 1/256 pixel.
void transform_mesh(const LightMesh& mesh, const Light& light, const View& view, const WindowTransform& window,
                    const int origin_fx[2], TransformedMesh& out);

/// Counts up how often the mesh covers each pixel of a tile, triangle by triangle: counts in tile_index() order.
void count_mesh(const LightMesh& mesh, const TransformedMesh& placed, const GeometryState& state,
                const WindowTransform& window, const TileRect& rect, uint16_t* counts);

}  // namespace trueshade
