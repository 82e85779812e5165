#pragma once
#include <type_traits>
#include <utility>
#include <vector>

namespace trueshade {

/// Threads that `requested` stands for: 0 is one for each core that this process may run on.
int thread_count(int requested);

/// What is called for each task of a loop: any function object that takes an int, not owned.
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

/// A parallel_for() that is over.
struct ParallelLoop {
  double most_core_ms;  ///< its wall time on each thread that it could use
  int tasks;
};

/// For its lifetime notes the parallel_for()s that this thread calls.
class LoopTimes {
 public:
  LoopTimes();
  ~LoopTimes();
  LoopTimes(const LoopTimes&) = delete;
  LoopTimes& operator=(const LoopTimes&) = delete;
  const std::vector<ParallelLoop>& loops() const { return loops_; }

 private:
  friend void parallel_for(int count, int threads, TaskRef body);
  std::vector<ParallelLoop> loops_;
  LoopTimes* outer_;
};

/// Calls body(i) for i in [0, count), on `threads` threads (0: one a core), each under FpScope, started in this order.
/// The first exception of a body reaches the caller.
void parallel_for(int count, int threads, TaskRef body);

/// Wakes the threads that loops are about to be shared with: that takes a twentieth of a millisecond, in which this
/// thread can do what it does alone.
void wake_threads(int threads);

}  // namespace trueshade
