#include "core/fp_env.h"

#include <algorithm>
#include <cfloat>
#include <chrono>
#include <thread>
#include <utility>

#include "core/thread_pool.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#error "Trueshade knows the floating-point control of x86-64 and aarch64 only"
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

}  // namespace

FpScope::FpScope() : saved_(control()) { set_control(kIeeeControl); }
FpScope::~FpScope() { set_control(saved_); }

int thread_count(int requested) {
  static const int cores = std::max(1, int(std::thread::hardware_concurrency()));  // asking takes 2 us
  return requested > 0 ? requested : cores;
}

namespace {
thread_local LoopLog* current_log = nullptr;
}

LoopLog::LoopLog() : outer_(std::exchange(current_log, this)) {}
LoopLog::~LoopLog() { current_log = outer_; }

void parallel_for(int count, int threads, TaskRef body) {
  const auto one = [body](int i) {
    const FpScope ieee;
    body(i);
  };
  threads = std::min(thread_count(threads), count);
  using Clock = std::chrono::steady_clock;
  LoopLog* const log = std::exchange(current_log, nullptr);  // loops inside this one are part of it
  const Clock::time_point start = log != nullptr ? Clock::now() : Clock::time_point();
  try {
    if (threads > 1)
      ThreadPool::shared().run(count, threads - 1, one);
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

void wake_threads(int threads) {
  if (thread_count(threads) > 1) ThreadPool::shared().rouse(thread_count(threads) - 1);
}

}  // namespace trueshade
