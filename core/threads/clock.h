#pragma once
#include <chrono>

namespace trueshade {

/// Milliseconds of a clock that never goes back; its zero means nothing.
inline double now_ms() {
  using namespace std::chrono;
  return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

/// Milliseconds since the process was started, to the hundredth of a second (Linux, proc(5): starttime of
/// /proc/self/stat); 0 where the system does not tell.
double process_ms();

}  // namespace trueshade
