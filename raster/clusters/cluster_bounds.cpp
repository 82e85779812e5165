#include "raster/clusters/cluster_bounds.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void append_seen(std::span<const ClusterRun> runs, const WindowTransform& window, std::vector<ClusterDraw>& out) {
  kernel<append_seen>()(runs, window, out);
}

bool may_be_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t index) {
  return kernel<may_be_seen>()(boxes, transform, window, index);
}
}  // namespace trueshade
