#pragma once
#include <cstdint>
#include <vector>

#include "raster/clusters.h"
#include "raster/view.h"
#include "raster/visibility.h"

namespace trueshade {

/// Appends the clusters [first, last) of an instance's mesh that may be seen, with the pixels they may touch,
/// ascending. Conservative: bounds are wider than any rounding of the vertex stage.
void append_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t instance, uint32_t first, uint32_t last, std::vector<ClusterDraw>& out);

/// Whether a box of an instance, one of `boxes`, may be seen.
bool may_be_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t index);

}  // namespace trueshade
