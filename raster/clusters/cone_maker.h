#pragma once
#include <cstddef>

#include "raster/clusters/clusters.h"

namespace trueshade {

/// A lane of ClusterCones.
struct NormalCone {
  float axis[3] = {}, cosine = 0.0f, sine = 1.0f, off_center = 0.0f, inradius = 0.0f;
};

/// The cone of the `index`-th cluster, whose vertices, corners and box the mesh has already. Nothing is known of a
/// cluster whose normals spread over a right angle or more, or one of whose triangles is too thin for a normal.
NormalCone normal_cone(const ClusteredMesh& mesh, const Cluster& cluster, size_t index);

void add_cone(const NormalCone& cone, ClusterCones& out);

}  // namespace trueshade
