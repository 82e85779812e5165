#include "bench/machine.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>

#include "core/fp_env.h"

namespace trueshade {
namespace {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

/// Best of a few runs of 2 million additions, each waiting for the one before.
double measured_clock_ghz() {
  using Clock = std::chrono::steady_clock;
  constexpr int kAdditions = 2'000'000;
  double best = 0.0;
  for (int run = 0; run < 8; ++run) {
    uint64_t x = 1;
    const auto start = Clock::now();
    for (int i = 0; i < kAdditions; i += 8) {
#pragma GCC unroll 8  // not unrolled, the loop's branch would be timed
      for (int k = 0; k < 8; ++k) {
        x += 1;
        asm volatile("" : "+r"(x));  // keeps the additions apart
      }
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    best = std::max(best, kAdditions / ns);
  }
  return best;
}

}  // namespace

Machine this_machine() { return {cpu_name(), thread_count(0), measured_clock_ghz()}; }

}  // namespace trueshade
