#pragma once
#include <string>

namespace trueshade {

/// What a time was measured on.
struct Machine {
  std::string cpu;       ///< as the system names it
  int cores = 0;         ///< that this process may use
  double clock_ghz = 0;  ///< measured: dependent multiplications a nanosecond, of three cycles each
};

Machine this_machine();

}  // namespace trueshade
