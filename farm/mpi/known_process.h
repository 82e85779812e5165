#pragma once
#include <cstdint>

namespace trueshade {

/// A process, by its number and its start time in /proc/PID/stat: numbers are used again for new processes.
struct KnownProcess {
  int32_t number = 0;
  uint64_t started = 0;  ///< clock ticks since the machine was; 0 where the process is not there, or not seen from here
};

/// The process that has this number now, as this process sees it; `started` is 0 for none. A zombie counts as none.
KnownProcess known_process(int number);

}  // namespace trueshade
