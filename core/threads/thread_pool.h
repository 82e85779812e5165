#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <vector>

#include "core/threads/parallel_for.h"
#include "core/threads/tbb_threads.h"

namespace trueshade {

/// TBB's threads, lent to loops. A thread that is out of work looks for the next loop for a tenth of a millisecond
/// before TBB has it back: being woken takes longer than most loops that come before a frame's tiles. Where no thread
/// comes, the caller does all of a loop.
class ThreadPool {
 public:
  static ThreadPool& shared();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls body(i) for i in [0, count), tasks started in this order, on this thread and up to `helpers`
  /// others. The first exception of a body ends the loop and reaches the caller. Loops may be within loops, and any
  /// thread may call: none waits for a thread but those at work on its own loop.
  void run(int count, int helpers, TaskRef body);
  /// Asks for `helpers` threads, for loops that come soon.
  void rouse(int helpers);

 private:
  struct Loop {
    TaskRef body;
    int count, room;              // room: for so many helpers more
    std::atomic<int> next{0};     // task
    std::atomic<int> helping{0};  // helpers at work
    std::mutex failed{};
    std::exception_ptr failure{};

    void work();
  };

  ThreadPool() = default;
  void serve();
  Loop* join_loop();
  void leave(Loop& loop);

  TbbThreads& threads_ = TbbThreads::shared();
  std::mutex mutex_;
  std::vector<Loop*> loops_;
  std::atomic<uint32_t> news_{0};  // counts what threads look for: new loops
  std::atomic<uint32_t> left_{0};  // counts helpers that have left a loop
  std::atomic<int> serving_{0};    // threads that are here or have been asked for
};

}  // namespace trueshade
