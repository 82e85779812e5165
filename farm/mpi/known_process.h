#pragma once
#include <cstdint>

namespace trueshade {

/// A process by its number and the time it was started at, as /proc/PID/stat has it: numbers are given again.
struct KnownProcess {
  int32_t number = 0;
  uint64_t started = 0;  ///< clock ticks since the machine was; 0 where the process is not there, or not seen from here
};

/// The process of that number as it is now, seen from this one. A zombie is not there.
KnownProcess known_process(int number);

}  // namespace trueshade
