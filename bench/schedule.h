#pragma once
#include <span>

namespace trueshade {

/// Wall time of tasks that `cores` cores take one after the other, each as soon as a core is free: what a frame's
/// tiles, measured on few cores, would take on more of the same, were memory and caches as fast for all.
double scheduled_ms(std::span<const double> task_ms, int cores);

}  // namespace trueshade
