#include "bench/schedule.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace trueshade {

double scheduled_ms(std::span<const double> task_ms, int cores) {
  std::vector<double> free_at(static_cast<size_t>(cores), 0.0);  // a heap, the soonest on top
  double end = 0.0;
  for (const double ms : task_ms) {
    std::pop_heap(free_at.begin(), free_at.end(), std::greater<>());
    free_at.back() += ms;
    end = std::max(end, free_at.back());
    std::push_heap(free_at.begin(), free_at.end(), std::greater<>());
  }
  return end;
}

double scheduled_frame_ms(const FrameStats& stats, std::span<const double> tile_ms, int cores) {
  double alone = stats.before_tiles_ms, shared = 0.0;
  for (const ParallelLoop& loop : stats.loops_before_tiles) {
    alone -= loop.most_core_ms / std::min(loop.tasks, std::max(1, stats.threads));
    shared += loop.most_core_ms / std::min(loop.tasks, cores);
  }
  return std::max(alone, 0.0) + shared + scheduled_ms(tile_ms, cores);
}

}  // namespace trueshade
