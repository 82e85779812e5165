#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <vector>

#include "core/threads/parallel_for.h"

namespace trueshade {

/// Threads, lent to loops. A thread that is out of work looks for the next loop for a tenth of a millisecond before it
/// is parked: being woken takes longer than most loops that come before a frame's tiles. Where the system starts no more
/// threads, loops go on with those there are; where there is none, the caller does all of a loop.
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
  bool call_helper();  ///< Wakes a parked thread or starts one; false where the system has none to give.
  void live();
  void serve();
  Loop* join_loop();
  void leave(Loop& loop);

  std::mutex mutex_;
  std::vector<Loop*> loops_;
  std::atomic<uint32_t> news_{0};  // counts what threads look for: new loops
  std::atomic<uint32_t> left_{0};  // counts helpers that have left a loop
  std::atomic<int> serving_{0};    // threads that are here or have been asked for
  std::mutex parking_;
  std::condition_variable wake_;
  int parked_ = 0, called_ = 0;  // called_: parked threads that have been asked for and have not come yet
};

}  // namespace trueshade
