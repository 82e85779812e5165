#pragma once
#include <type_traits>

namespace trueshade {

/// Threads that `requested` stands for: 0 is one a core.
int thread_count(int requested);

/// The body of a loop: any function object that takes an int. The loop borrows it.
class TaskRef {
 public:
  template <class Body>
  requires(!std::is_same_v<std::remove_cvref_t<Body>, TaskRef>) TaskRef(const Body& body)
      : body_(&body), call_([](const void* of, int i) { (*static_cast<const Body*>(of))(i); }) {}
  void operator()(int i) const { call_(body_, i); }

 private:
  const void* body_;
  void (*call_)(const void*, int);
};

/// Calls body(i) for i in [0, count) on `threads` threads (0: one a core). Tasks start in the order of i, each under
/// FpScope. The first exception of a body ends the loop and reaches the caller.
void parallel_for(int count, int threads, TaskRef body);

/// Wakes the threads that coming loops will share. Waking takes a twentieth of a millisecond, which the caller can
/// spend on work that it does alone.
void wake_threads(int threads);

}  // namespace trueshade
