#include "core/threads/thread_pool.h"

#include <algorithm>
#include <chrono>
#include <thread>

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

// Never destroyed: TBB's threads may look in while the process ends.
ThreadPool& ThreadPool::shared() {
  static ThreadPool& pool = *new ThreadPool;
  return pool;
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

void ThreadPool::rouse(int helpers) {
  ++news_;
  helpers = threads_.make_room(helpers);
  // Counted once: threads that leave for want of work while others are still being asked for are not replaced.
  for (int missing = helpers - serving_; missing > 0; --missing) {
    ++serving_;
    if (threads_.call([](void* pool) { static_cast<ThreadPool*>(pool)->serve(); }, this)) continue;
    --serving_;
    return;
  }
}

void ThreadPool::run(int count, int helpers, TaskRef body) {
  Loop loop{body, count, helpers};
  {
    const std::lock_guard lock(mutex_);
    loops_.push_back(&loop);
  }
  rouse(std::min(helpers, count - 1));
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
    if (Loop* const loop = join_loop()) {
      loop->work();
      leave(*loop);
      continue;
    }
    if (wait_awake(kLookForWork, [&] { return news_ != seen; })) continue;
    --serving_;
    if (news_ == seen) return;
    ++serving_;  // a loop came meanwhile and may have counted on this thread
  }
}

}  // namespace trueshade
