#include "core/fp_env.h"

#include <atomic>
#include <cfenv>
#include <chrono>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/threads/loop_watch.h"
#include "core/threads/parallel_for.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// Whether this thread rounds to nearest even and keeps denormals, found by computing.
[[gnu::noinline]] bool computes_as_ieee() {
  volatile float one = 1.0f, tie = 0x1p-24f, above = 0x1.8p-24f, denormal = std::numeric_limits<float>::denorm_min();
  return one + tie == 1.0f && one + above == 1.0f + 0x1p-23f && -one - tie == -1.0f && denormal * 2.0f != 0.0f &&
         0x1p-126f * (one / 2) != 0.0f;
}

TEST_CASE("FpScope computes as IEEE 754 says and gives the caller's settings back") {
  CHECK(computes_as_ieee());
  std::fesetround(FE_UPWARD);
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
  const unsigned before = _mm_getcsr();
#endif
  const bool hostile = !computes_as_ieee();
  bool inside = false;
  {
    const FpScope ieee;
    inside = computes_as_ieee();
  }
#if defined(__x86_64__)
  const unsigned after = _mm_getcsr();
  _mm_setcsr(0x1f80);
  CHECK(after == before);
#endif
  std::fesetround(FE_TONEAREST);
  CHECK(hostile);
  CHECK(inside);
}

TEST_CASE("A log of loops has those that its thread calls, each with its tasks, and no others") {
  parallel_for(3, 2, [](int) {});
  const LoopTimes log;
  parallel_for(5, 2, [](int) { parallel_for(7, 1, [](int) {}); });
  parallel_for(0, 2, [](int) {});
  {
    const LoopTimes inner;
    parallel_for(9, 1, [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
    REQUIRE(inner.loops().size() == 1);
    CHECK(inner.loops()[0].tasks == 9);
    CHECK(inner.loops()[0].most_core_ms >= 18.0);
  }
  CHECK_THROWS(parallel_for(4, 2, [](int) { throw std::runtime_error("no"); }));
  parallel_for(2, 64, [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  REQUIRE(log.loops().size() == 2);
  CHECK(log.loops()[0].tasks == 5);
  CHECK(log.loops()[1].tasks == 2);
  CHECK(log.loops()[1].most_core_ms >= 4.0);  // both threads'
}

TEST_CASE("parallel_for calls every index once and under IEEE arithmetic, whatever the caller's settings") {
  for (const int threads : {0, 1, 2, 3, 8, 64}) {
    std::vector<std::atomic<int>> calls(1000);
    std::atomic<int> wrong{0};
    std::fesetround(FE_DOWNWARD);
    parallel_for(1000, threads, [&](int i) {
      ++calls[size_t(i)];
      if (!computes_as_ieee()) ++wrong;
    });
    const int round = std::fegetround();
    std::fesetround(FE_TONEAREST);
    CHECK(round == FE_DOWNWARD);
    CHECK(wrong == 0);
    for (const auto& count : calls) REQUIRE(count == 1);
  }
  parallel_for(0, 4, [](int) { FAIL("called for an empty range"); });
}

TEST_CASE("parallel_for runs as many threads as asked for, beyond the number of cores") {
  for (const int threads : {2, 8, 64}) {
    std::mutex mutex;
    std::set<std::thread::id> seen;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    parallel_for(threads, threads, [&](int) {  // each call waits for all the others, so each needs its own thread
      {
        const std::lock_guard lock(mutex);
        seen.insert(std::this_thread::get_id());
      }
      for (bool all = false; !all && std::chrono::steady_clock::now() < deadline;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::lock_guard lock(mutex);
        all = int(seen.size()) == threads;
      }
    });
    CHECK(int(seen.size()) == threads);
  }
}

TEST_CASE("loops within loops, of several callers at once, call every index once") {
  constexpr int kCallers = 4, kOuter = 20, kInner = 50;
  std::vector<std::atomic<int>> calls(size_t(kCallers * kOuter * kInner));
  std::vector<std::thread> callers;
  for (int caller = 0; caller < kCallers; ++caller)
    callers.emplace_back([&, caller] {
      wake_threads(3);
      parallel_for(kOuter, 3, [&](int outer) {
        parallel_for(kInner, 2 + outer % 3, [&](int inner) {
          ++calls[size_t((caller * kOuter + outer) * kInner + inner)];
          if (inner == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));  // until threads sleep
        });
      });
    });
  for (std::thread& caller : callers) caller.join();
  for (const auto& count : calls) REQUIRE(count == 1);
}

TEST_CASE("an exception in a loop within a loop reaches the outer caller, and loops after it are whole") {
  CHECK_THROWS_AS(parallel_for(8, 4,
                               [](int) {
                                 parallel_for(8, 4, [](int i) {
                                   if (i == 5) throw std::runtime_error("5");
                                 });
                               }),
                  std::runtime_error);
  std::atomic<int> sum{0};
  parallel_for(100, 4, [&](int i) { sum += i; });
  CHECK(sum == 4950);
}

TEST_CASE("tasks are started in their order: none overtakes another by more than the threads at work") {
  constexpr int kTasks = 2000, kThreads = 4;
  std::vector<int> started(kTasks);
  std::atomic<int> ticket{0};
  parallel_for(kTasks, kThreads, [&](int i) {
    started[size_t(i)] = ticket++;
    std::this_thread::yield();
  });
  // Of the tasks before i at most one a thread has been taken and has not drawn its ticket; those after i are as few.
  for (int i = 0; i < kTasks; ++i) CHECK(started[size_t(i)] >= i - (kThreads - 1));
}

TEST_CASE("an exception of a body reaches the caller of parallel_for") {
  for (const int threads : {1, 4})
    CHECK_THROWS_AS(parallel_for(100, threads,
                                 [](int i) {
                                   if (i == 37) throw std::runtime_error("37");
                                 }),
                    std::runtime_error);
}

TEST_CASE("a watch sees how far this thread's loops are, and not those inside of them") {
  std::vector<std::pair<int, int>> seen;
  {
    const LoopWatch watch([&seen](int done, int count) { seen.emplace_back(done, count); });
    parallel_for(5, 1, [](int) { parallel_for(3, 1, [](int) {}); });
    CHECK(seen == std::vector<std::pair<int, int>>{{1, 5}, {2, 5}, {3, 5}, {4, 5}, {5, 5}});
    seen.clear();
    CHECK_THROWS(parallel_for(4, 1, [](int i) {
      if (i == 2) throw std::runtime_error("ends");
    }));
    CHECK(seen == std::vector<std::pair<int, int>>{{1, 4}, {2, 4}});
    seen.clear();
    parallel_for(1000, 4, [](int) {});
    for (size_t i = 0; i + 1 < seen.size(); ++i) CHECK(seen[i].first < seen[i + 1].first);
    CHECK((seen.empty() || seen.back().first <= 1000));
  }
  seen.clear();
  parallel_for(5, 1, [](int) {});
  CHECK(seen.empty());
}

}  // namespace
}  // namespace trueshade
