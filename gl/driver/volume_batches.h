#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "gl/driver/objects.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// The geometry of all lights on the GPU, in light order, for as few draws as their state allows: vertices are
/// (corner, index of the light), attributes 0 and 1.
struct VolumeBatches {
  struct Run {
    bool mesh;         ///< of meshes in the world; otherwise quads over the image
    GLsizei count;     ///< indices
    size_t first = 0;  ///< index
  };
  GlVertexArray array;
  GlBuffer vertices, indices;
  std::vector<Run> runs;  ///< to be drawn in this order, GL_TRIANGLES, GL_UNSIGNED_INT
};

/// Extents as drawn_extent() gives them, vertices as light_vertices() does. The context must be current.
VolumeBatches make_volume_batches(std::span<const Light> lights, const LightVolumes& volumes);

}  // namespace trueshade::oracle
