#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/fp_env.h"

namespace trueshade {

/// Threads that loops share, started when they are first needed and kept. Between loops they look for the next one for
/// a tenth of a millisecond before they sleep: being woken takes longer than most loops that come before a frame's
/// tiles.
class ThreadPool {
 public:
  static ThreadPool& shared();
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls body(i) for i in [0, count) on this thread and up to `helpers` others. The first exception of a body ends
  /// the loop and reaches the caller. Loops may be within loops, and any thread may call: none waits for a thread but
  /// those at work on its own loop.
  void run(int count, int helpers, TaskRef body);
  /// Wakes `helpers` threads, for loops that come soon.
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
  void start_threads(int helpers);  // mutex_ is held
  void serve();
  Loop* join_loop();
  void leave(Loop& loop);

  std::mutex mutex_;
  std::vector<Loop*> loops_;
  std::vector<std::thread> threads_;
  std::atomic<uint32_t> news_{0};  // counts what threads look for: new loops, and the end
  std::atomic<uint32_t> left_{0};  // counts helpers that have left a loop
  std::atomic<int> looking_{0};    // threads that are awake and without work
  std::atomic<bool> ended_{false};
};

}  // namespace trueshade
