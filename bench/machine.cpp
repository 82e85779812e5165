#include "bench/machine.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>

#include "core/threads/parallel_for.h"

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

/// Best of a few runs of 2 million multiplications of 32 bits, each of which waits three cycles for the one before, on
/// every x86-64 core since Nehalem and Zen (Agner Fog's and uops.info's tables). Additions of a constant will not do:
/// newer cores (Golden Cove) carry out six dependent ones a cycle while they rename registers.
double measured_clock_ghz() {
  using Clock = std::chrono::steady_clock;
  constexpr int kMultiplications = 2'000'000;
  constexpr double kLatency = 3.0;
  double best = 0.0;
  for (int run = 0; run < 8; ++run) {
    uint32_t x = 3;
    const auto start = Clock::now();
    for (int i = 0; i < kMultiplications; ++i) {
      x *= x;
      asm volatile("" : "+r"(x));  // keeps them apart
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    best = std::max(best, kLatency * kMultiplications / ns);
  }
  return best;
}

}  // namespace

Machine this_machine() { return {cpu_name(), thread_count(0), measured_clock_ghz()}; }

}  // namespace trueshade
