#pragma once
#include <chrono>

namespace trueshade {

/// Milliseconds of a clock that never goes back; its zero means nothing.
inline double now_ms() {
  using namespace std::chrono;
  return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace trueshade
