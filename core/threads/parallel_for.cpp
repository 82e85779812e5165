#include "core/threads/parallel_for.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/fp_env.h"
#include "core/threads/thread_pool.h"

namespace trueshade {

int thread_count(int requested) {
  static const int cores = std::max(1, int(std::thread::hardware_concurrency()));  // asking takes 2 us
  return requested > 0 ? requested : cores;
}

namespace {
thread_local LoopTimes* current = nullptr;
}

LoopTimes::LoopTimes() : outer_(std::exchange(current, this)) {}
LoopTimes::~LoopTimes() { current = outer_; }

void parallel_for(int count, int threads, TaskRef body) {
  const FpScope fp;
  const auto one = [body](int i) {
    const FpScope ieee;
    body(i);
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
