#include "core/fp_env.h"

#include <algorithm>
#include <atomic>
#include <cfloat>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#if defined(__x86_64__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#error "Trueshade knows the floating-point control of x86-64 and aarch64 only"
#endif

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
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace trueshade {

static_assert(FLT_EVAL_METHOD == 0, "float arithmetic must round to float after every operation");

namespace {

#if defined(__x86_64__)
constexpr uint64_t kIeeeControl = 0x1f80;  // MXCSR: all traps masked, nearest even, neither FTZ nor DAZ, no flag set
uint64_t control() { return _mm_getcsr(); }
void set_control(uint64_t value) { _mm_setcsr(uint32_t(value)); }
#else
constexpr uint64_t kIeeeControl = 0;  // FPCR: no traps, nearest even, no FZ, no default NaN
uint64_t control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_control(uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#endif

#if TRUESHADE_PLAIN_THREADS
void run_on_threads(int count, int threads, const std::function<void(int)>& one) {
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) one(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  helpers.clear();
  if (failure) std::rethrow_exception(failure);
}
#else
void run_on_threads(int count, int threads, const std::function<void(int)>& one) {
  // An arena holds the number down by itself; only more threads than cores need the process-wide limit raised.
  std::optional<tbb::global_control> more;
  if (threads > thread_count(0)) more.emplace(tbb::global_control::max_allowed_parallelism, size_t(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(0, count, one, tbb::simple_partitioner()); });
}
#endif

}  // namespace

FpScope::FpScope() : saved_(control()) { set_control(kIeeeControl); }
FpScope::~FpScope() { set_control(saved_); }

int thread_count(int requested) {
  return requested > 0 ? requested : std::max(1, int(std::thread::hardware_concurrency()));
}

namespace {
thread_local LoopLog* current_log = nullptr;
}

LoopLog::LoopLog() : outer_(std::exchange(current_log, this)) {}
LoopLog::~LoopLog() { current_log = outer_; }

void parallel_for(int count, int threads, const std::function<void(int)>& body) {
  const auto one = [&body](int i) {
    const FpScope ieee;
    body(i);
  };
  threads = std::min(thread_count(threads), count);
  using Clock = std::chrono::steady_clock;
  LoopLog* const log = std::exchange(current_log, nullptr);  // loops inside this one are part of it
  const Clock::time_point start = log != nullptr ? Clock::now() : Clock::time_point();
  try {
    if (threads > 1)
      run_on_threads(count, threads, one);
    else
      for (int i = 0; i < count; ++i) one(i);
  } catch (...) {
    current_log = log;
    throw;
  }
  current_log = log;
  if (log == nullptr || count == 0) return;
  const double wall = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  log->loops_.push_back({wall * threads, count});
}

}  // namespace trueshade
