#include "programs/values/program_limits.h"

#include <algorithm>
#include <mutex>

namespace trueshade::programs {
namespace {

std::mutex mutex;
ProgramLimits of_process;

}  // namespace

ProgramLimits program_limits() {
  const std::lock_guard lock(mutex);
  return of_process;
}

void set_program_limits(const ProgramLimits& limits) {
  constexpr size_t kMostNodes = size_t(1) << 26;  // that a number of 32 bits counts, with those that are left out
  constexpr uint64_t kMostSeconds = 100'000'000;
  const std::lock_guard lock(mutex);
  of_process = limits;
  of_process.nodes = std::min(limits.nodes, kMostNodes);
  of_process.seconds = std::min(limits.seconds, kMostSeconds);
}

}  // namespace trueshade::programs
