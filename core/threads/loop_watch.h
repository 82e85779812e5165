#pragma once
#include <functional>

namespace trueshade {

/// For its lifetime tells of the parallel_for()s that this thread calls, but for those inside of others. `see` is
/// called on this thread alone, after each of the tasks that it does itself: how many are done by all threads, of how
/// many.
class LoopWatch {
 public:
  explicit LoopWatch(std::function<void(int done, int count)> see);
  ~LoopWatch();
  LoopWatch(const LoopWatch&) = delete;
  LoopWatch& operator=(const LoopWatch&) = delete;

 private:
  friend class WatchedLoop;
  std::function<void(int, int)> see_;
  LoopWatch* outer_;
};

}  // namespace trueshade
