#include "core/threads/tbb_threads.h"

#include <algorithm>
#include <new>
#include <optional>
#include <thread>

#include "core/threads/parallel_for.h"
#include "core/threads/startable_threads.h"

// Debian's TBB is not built for ThreadSanitizer, which then sees races that are none. Under it, plain threads serve.
#if defined(__SANITIZE_THREAD__)
#define TRUESHADE_PLAIN_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TRUESHADE_PLAIN_THREADS 1
#endif
#endif
#ifndef TRUESHADE_PLAIN_THREADS
#define TRUESHADE_PLAIN_THREADS 0
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#endif

namespace trueshade {

#if TRUESHADE_PLAIN_THREADS
struct TbbThreads::Arena {
  void set_room(int) {}
  void call(void (*task)(void*), void* context) { std::thread(task, context).detach(); }
};
#else
struct TbbThreads::Arena {
  void set_room(int helpers) {
    arena.terminate();  // threads that are in it stay
    // An arena holds the number down by itself; only more threads than cores need the process's limit raised.
    if (helpers >= thread_count(0)) more.emplace(tbb::global_control::max_allowed_parallelism, size_t(helpers) + 1);
    arena.initialize(helpers, 0);
  }
  void call(void (*task)(void*), void* context) {
    arena.enqueue([=] { task(context); });
  }

  tbb::task_arena arena;
  std::optional<tbb::global_control> more;
};
#endif

TbbThreads::TbbThreads() : arena_(std::make_unique<Arena>()) {}
TbbThreads::~TbbThreads() = default;

// Never destroyed: TBB's threads may look in while the process ends.
TbbThreads& TbbThreads::shared() {
  static TbbThreads& threads = *new TbbThreads;
  return threads;
}

int TbbThreads::make_room(int helpers) {
  if (helpers <= tried_) return std::min(helpers, room_.load());
  const std::lock_guard lock(mutex_);
  if (helpers > tried_) {
    tried_ = helpers;
    try {
      if (const int more = startable_threads(helpers - room_); more > 0) {
        arena_->set_room(room_ + more);
        room_ += more;
      }
    } catch (const std::bad_alloc&) {  // the threads that there are do
    }
  }
  return std::min(helpers, room_.load());
}

bool TbbThreads::call(void (*task)(void*), void* context) {
  const std::lock_guard lock(mutex_);
  try {
    arena_->call(task, context);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

}  // namespace trueshade
