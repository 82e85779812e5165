#pragma once
#include <atomic>
#include <memory>
#include <mutex>

namespace trueshade {

/// Threads of TBB, which this process shares with every other user of TBB in it; a host's limits on TBB hold here too.
/// TBB ends the process where the system does not start a thread, so make_room() tries first how many it starts.
class TbbThreads {
 public:
  static TbbThreads& shared();
  TbbThreads(const TbbThreads&) = delete;
  TbbThreads& operator=(const TbbThreads&) = delete;

  /// Makes room for `helpers` threads at once; returns how many of them there are, fewer where the system has no more.
  int make_room(int helpers);
  /// Calls task(context) on one of the threads, when one is free; false if memory for that is lacking. make_room() has
  /// found one or more. An exception of the task ends the process.
  bool call(void (*task)(void*), void* context);

 private:
  TbbThreads();
  ~TbbThreads();

  struct Arena;  // TBB's headers are seen by one source file
  std::mutex mutex_;
  std::atomic<int> tried_{0}, room_{0};  // threads asked for at most so far, and those of them that there are
  std::unique_ptr<Arena> arena_;
};

}  // namespace trueshade
