#pragma once
#include <cstdint>

namespace trueshade {

/// For its lifetime this thread computes as IEEE 754 says: round to nearest even, denormals kept, no traps. The
/// caller's settings come back on exit: a host may run with flush-to-zero or another rounding, and must find it as it
/// left it.
class FpScope {
 public:
  FpScope();
  ~FpScope();
  FpScope(const FpScope&) = delete;
  FpScope& operator=(const FpScope&) = delete;

 private:
  uint64_t saved_;
};

}  // namespace trueshade
