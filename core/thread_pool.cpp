#include "core/thread_pool.h"

#include <algorithm>
#include <chrono>
#include <exception>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace trueshade {
namespace {

void pause_core() {
#if defined(__x86_64__)
  _mm_pause();
#else
  asm volatile("yield");
#endif
}

// Waits awake until `holds`, at first for the thread alone, then giving way to others that want the core. Returns
// whether it does.
template <class Holds>
bool wait_awake(std::chrono::microseconds most, const Holds& holds) {
  constexpr int kPauses = 1000;  // some 20 us
  for (int i = 0; i < kPauses; ++i) {
    if (holds()) return true;
    pause_core();
  }
  using Clock = std::chrono::steady_clock;
  for (const Clock::time_point end = Clock::now() + most; Clock::now() < end; std::this_thread::yield())
    if (holds()) return true;
  return holds();
}

constexpr std::chrono::microseconds kLookForWork{100}, kLookForEnd{2000};

}  // namespace

ThreadPool& ThreadPool::shared() {
  static ThreadPool pool;
  return pool;
}

ThreadPool::~ThreadPool() {
  ended_ = true;
  ++news_;
  news_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::Loop::work() {
  try {
    for (int i = next++; i < count; i = next++) body(i);
  } catch (...) {
    next = count;
    const std::lock_guard lock(failed);
    if (!failure) failure = std::current_exception();
  }
}

void ThreadPool::start_threads(int helpers) {
  while (int(threads_.size()) < helpers) threads_.emplace_back([this] { serve(); });
}

void ThreadPool::rouse(int helpers) {
  {
    const std::lock_guard lock(mutex_);
    start_threads(helpers);
  }
  ++news_;
  for (int i = looking_; i < helpers; ++i) news_.notify_one();
}

void ThreadPool::run(int count, int helpers, TaskRef body) {
  Loop loop{body, count, helpers};
  {
    const std::lock_guard lock(mutex_);
    loops_.push_back(&loop);
  }
  rouse(helpers);
  loop.work();
  {
    const std::lock_guard lock(mutex_);
    std::erase(loops_, &loop);  // nobody joins it any more
  }
  const auto over = [&] { return loop.helping == 0; };
  for (uint32_t seen = left_; !wait_awake(kLookForEnd, over); seen = left_)
    if (!over()) left_.wait(seen);
  if (loop.failure) std::rethrow_exception(loop.failure);
}

ThreadPool::Loop* ThreadPool::join_loop() {
  const std::lock_guard lock(mutex_);
  for (auto it = loops_.rbegin(); it != loops_.rend(); ++it) {
    Loop& loop = **it;
    if (loop.room == 0 || loop.next >= loop.count) continue;
    --loop.room;
    ++loop.helping;
    return &loop;
  }
  return nullptr;
}

void ThreadPool::leave(Loop& loop) {
  --loop.helping;  // its owner may be gone from here on
  ++left_;
  left_.notify_all();
}

void ThreadPool::serve() {
  while (true) {
    const uint32_t seen = news_;
    if (ended_) return;
    if (Loop* const loop = join_loop()) {
      loop->work();
      leave(*loop);
      continue;
    }
    ++looking_;
    const bool more = wait_awake(kLookForWork, [&] { return news_ != seen; });
    --looking_;
    if (!more) news_.wait(seen);
  }
}

}  // namespace trueshade
