#pragma once
#include <span>

#include "shading/frame.h"

namespace trueshade {

/// Wall time of tasks that `cores` cores take one after the other, each as soon as a core is free: what a frame's
/// tiles, measured on few cores, would take on more of the same, were memory and caches as fast for all.
double scheduled_ms(std::span<const double> task_ms, int cores);

/// Wall time of a frame on `cores` cores: what precedes its tiles by one core, but for the loops that threads share and
/// that as many cores as they have tasks can take; then the tiles.
double scheduled_frame_ms(const FrameStats& stats, std::span<const double> tile_ms, int cores);

}  // namespace trueshade
