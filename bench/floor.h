#pragma once
#include "shading/frame.h"

namespace trueshade {

/// CPU cycles of one core that a frame's counts would cost if nothing ever waited: unit costs measured or port-bound
/// on Zen 4 with AVX-512 (docs/performance.md). A model, for the share of it that a frame reaches; not a promise.
struct FrameFloor {
  double geometry_cycles = 0;  ///< set-up, samples, surfaces
  double light_cycles = 0;     ///< vectors of pixel-lights, store
  double ms(double clock_ghz, int cores) const { return (geometry_cycles + light_cycles) / (clock_ghz * 1e6 * cores); }
};

/// What a frame cannot do without moving: texels of the target, and each cluster drawn in a tile.
struct FrameBytes {
  uint64_t stored, clusters;
};
FrameBytes frame_bytes(const FrameStats& stats, Format target);

FrameFloor frame_floor(const FrameStats& stats);

}  // namespace trueshade
