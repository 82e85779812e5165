#pragma once
#include <vector>

#include "core/threads/parallel_for.h"

namespace trueshade {

/// A parallel_for() that has ended.
struct ParallelLoop {
  double most_core_ms;  ///< its wall time multiplied by the threads that it could use
  int tasks;
};

/// For its lifetime records the parallel_for()s that this thread calls. Loops within loops count as part of the outer
/// one.
class LoopTimes {
 public:
  LoopTimes();
  ~LoopTimes();
  LoopTimes(const LoopTimes&) = delete;
  LoopTimes& operator=(const LoopTimes&) = delete;
  const std::vector<ParallelLoop>& loops() const { return loops_; }

 private:
  friend void parallel_for(int count, int threads, TaskRef body);
  std::vector<ParallelLoop> loops_;
  LoopTimes* outer_;
};

}  // namespace trueshade
