#pragma once
#include <array>
#include <cstdint>

namespace trueshade {

/// For its lifetime this thread computes as IEEE 754 says: round to nearest even, denormals kept, no traps. The
/// caller's settings come back on exit: a host may run with flush-to-zero, another rounding or traps, and must find
/// them as it left them. On x86-64 this holds for the x87 unit too, whose rounding strtod() and printf() follow.
///
/// Every public function that touches a floating-point number, or calls a library that may, opens with an FpScope of
/// its own, whoever calls it (tests/fp_modes/public_functions.cpp calls each under every mode).
class FpScope {
 public:
  FpScope();
  ~FpScope();
  FpScope(const FpScope&) = delete;
  FpScope& operator=(const FpScope&) = delete;

 private:
  uint64_t saved_;
  bool x87_changed_ = false;
  std::array<uint32_t, 7> x87_;  ///< the x87 unit's environment, saved where the caller's control word is not usual
};

}  // namespace trueshade
