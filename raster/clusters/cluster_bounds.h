#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raster/clusters/clusters.h"
#include "raster/view.h"
#include "raster/clusters/cluster_draw.h"

namespace trueshade {

/// Clusters [first, last) of an instance's mesh, at least one.
struct ClusterRun {
  const ClusteredMesh* mesh;
  const InstanceTransform* transform;
  uint32_t instance, first, last;
};

/// Appends those clusters of the runs that may be seen, with the pixels they may touch, in the runs' order.
/// Conservative: bounds are wider than any rounding of the vertex stage.
void append_seen(std::span<const ClusterRun> runs, const WindowTransform& window, std::vector<ClusterDraw>& out);

/// Whether a box of an instance, one of `boxes`, may be seen.
bool may_be_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t index);

}  // namespace trueshade
