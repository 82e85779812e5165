#include "core/threads/parallel_for.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "core/fp_env.h"
#include "core/threads/granted_threads.h"
#include "core/threads/loop_watch.h"
#include "core/threads/thread_pool.h"

namespace trueshade {

namespace {
std::atomic<int> granted{0};

/// Those that this process may run on; since glibc 2.35 hardware_concurrency() counts the others too.
int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, int(std::thread::hardware_concurrency()));
}
}  // namespace

void grant_threads(int threads) { granted = threads; }

int thread_count(int requested) {
  return requested > 0 ? requested : granted > 0 ? int{granted} : usable_cores();  // ranks undo a binding as they join
}

namespace {
thread_local LoopTimes* current = nullptr;
thread_local LoopWatch* watching = nullptr;
}  // namespace

LoopWatch::LoopWatch(std::function<void(int, int)> see) : see_(std::move(see)), outer_(std::exchange(watching, this)) {}
LoopWatch::~LoopWatch() { watching = outer_; }

/// One loop, told of by the thread that called it. Loops inside it are not.
class WatchedLoop {
 public:
  explicit WatchedLoop(int count) : watch_(std::exchange(watching, nullptr)), count_(count) {}
  ~WatchedLoop() { watching = watch_; }
  WatchedLoop(const WatchedLoop&) = delete;
  WatchedLoop& operator=(const WatchedLoop&) = delete;
  void task_done() {
    if (watch_ == nullptr) return;
    const int done = ++done_;
    if (std::this_thread::get_id() == caller_) watch_->see_(done, count_);
  }

 private:
  LoopWatch* const watch_;
  const int count_;
  const std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<int> done_{0};
};

LoopTimes::LoopTimes() : outer_(std::exchange(current, this)) {}
LoopTimes::~LoopTimes() { current = outer_; }

void parallel_for(int count, int threads, TaskRef body) {
  const FpScope fp;
  WatchedLoop watched(count);
  const auto one = [&watched, body](int i) {
    {
      const FpScope ieee;
      body(i);
    }
    watched.task_done();
  };
  threads = std::min(thread_count(threads), count);
  using Clock = std::chrono::steady_clock;
  LoopTimes* const times = std::exchange(current, nullptr);  // loops inside this one are part of it
  const Clock::time_point start = times != nullptr ? Clock::now() : Clock::time_point();
  try {
    if (threads > 1)
      ThreadPool::shared().run(count, threads - 1, one);
    else
      for (int i = 0; i < count; ++i) one(i);
  } catch (...) {
    current = times;
    throw;
  }
  current = times;
  if (times == nullptr || count == 0) return;
  const double wall = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  times->loops_.push_back({wall * threads, count});
}

void wake_threads(int threads) {
  if (thread_count(threads) > 1) ThreadPool::shared().rouse(thread_count(threads) - 1);
}

}  // namespace trueshade
