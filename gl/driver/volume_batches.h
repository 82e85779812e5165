#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "gl/driver/objects.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// The geometry of all lights on the GPU, in the order of the lights, for as few draw calls as their state allows.
/// Vertices have the attributes 0, the corner, and 1, the light's index.
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

/// Makes the geometry of lights, with extents by drawn_extent() and vertices by light_vertices(). The context must be
/// current.
VolumeBatches make_volume_batches(std::span<const Light> lights, const LightVolumes& volumes);

}  // namespace trueshade::oracle
