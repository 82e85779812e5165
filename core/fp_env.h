#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace trueshade {

/// For its lifetime this thread computes as IEEE 754 says: round to nearest even, denormals kept, no traps. The
/// caller's settings come back on exit: a host may run with flush-to-zero or another rounding, and must find it as it
/// left it.
class FpScope {
 public:
  FpScope();
  ~FpScope();
  FpScope(const FpScope&) = delete;
  FpScope& operator=(const FpScope&) = delete;

 private:
  uint64_t saved_;
};

/// Threads that `requested` stands for: 0 is one a core.
int thread_count(int requested);

/// A parallel_for() that is over.
struct ParallelLoop {
  double core_ms;  ///< at most: its wall time on each thread that it could use
  int tasks;
};

/// For its lifetime notes the parallel_for()s that this thread calls.
class LoopLog {
 public:
  LoopLog();
  ~LoopLog();
  LoopLog(const LoopLog&) = delete;
  LoopLog& operator=(const LoopLog&) = delete;
  const std::vector<ParallelLoop>& loops() const { return loops_; }

 private:
  friend void parallel_for(int count, int threads, const std::function<void(int)>& body);
  std::vector<ParallelLoop> loops_;
  LoopLog* outer_;
};

/// Calls body(i) for i in [0, count), on `threads` threads (0: one a core), each under FpScope, in no promised order.
/// Exceptions of a body reach the caller. The only place that names TBB.
void parallel_for(int count, int threads, const std::function<void(int)>& body);

}  // namespace trueshade
