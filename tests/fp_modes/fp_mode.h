#pragma once
#include <string>
#include <vector>

namespace trueshade {

enum class Rounding { nearest, downward, upward, toward_zero };

/// A thread's floating-point settings, as a host may have left them.
struct FpMode {
  Rounding rounding = Rounding::nearest;
  bool flushes = false;  ///< Denormal results become 0, and denormal operands count as 0.
  bool traps = false;    ///< Every exception raises SIGFPE, the inexact result too.
  bool operator==(const FpMode&) const = default;
};

/// Four roundings, with and without flushing, with and without traps.
std::vector<FpMode> all_fp_modes();

/// Such as "downward, flushing, trapping".
std::string text_of(const FpMode& mode);

/// Sets this thread's mode; of an x86-64 CPU the vector unit's and the x87 unit's.
void set_fp_mode(const FpMode& mode);

/// This thread's mode. Flags that are raised do not count.
FpMode current_fp_mode();

}  // namespace trueshade
