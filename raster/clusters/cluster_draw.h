#pragma once
#include <cstdint>

namespace trueshade {

/// A cluster of an instance that may be seen; cluster_bins.h lists them.
struct ClusterDraw {
  uint32_t instance;
  uint32_t cluster;         ///< of the instance's mesh
  float near_depth;         ///< no fragment of the cluster is nearer; -infinity where no bound is known
  bool no_clip;             ///< the bounds prove that no vertex needs clipping (WindowVertices::needs_clip)
  uint16_t x0, y0, x1, y1;  ///< pixels it may touch, inclusive, window coordinates, y up
};

/// A tile lists fewer clusters than this, so that a position in its list fits into 24 bits.
inline constexpr uint32_t kMaxTileClusters = (uint32_t(1) << 24) - 2;

}  // namespace trueshade
