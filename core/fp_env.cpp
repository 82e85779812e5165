#include "core/fp_env.h"

#include <cfloat>

#if defined(__x86_64__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#error "Trueshade knows the floating-point control of x86-64 and aarch64 only"
#endif

namespace trueshade {

static_assert(FLT_EVAL_METHOD == 0, "float arithmetic must round to float after every operation");

namespace {

#if defined(__x86_64__)
constexpr uint64_t kIeeeControl = 0x1f80;  // MXCSR: all traps masked, nearest even, neither FTZ nor DAZ, no flag set
uint64_t control() { return _mm_getcsr(); }
void set_control(uint64_t value) { _mm_setcsr(uint32_t(value)); }

constexpr uint16_t kUsualX87 = 0x037f;  // all traps masked, nearest even, 64 bits of precision

/// Saves the x87 environment and sets the usual control word, if the word in force is another one. Returns whether it
/// did. Threads almost never differ, and then this costs one store of the control word.
bool set_usual_x87(std::array<uint32_t, 7>& saved) {
  uint16_t word;
  asm volatile("fnstcw %0" : "=m"(word));
  if (word == kUsualX87) return false;
  asm volatile("fnstenv %0\n\tfldcw %1" : "=m"(saved) : "m"(kUsualX87));
  return true;
}

/// The whole environment, not only the control word: flags raised in between would trap at the caller's next operation.
void restore_x87(const std::array<uint32_t, 7>& saved) { asm volatile("fldenv %0" : : "m"(saved)); }
#else
bool set_usual_x87(std::array<uint32_t, 7>&) { return false; }
void restore_x87(const std::array<uint32_t, 7>&) {}

constexpr uint64_t kIeeeControl = 0;  // FPCR: no traps, nearest even, no FZ, no default NaN
uint64_t control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_control(uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#endif

}  // namespace

FpScope::FpScope() : saved_(control()), x87_changed_(set_usual_x87(x87_)) { set_control(kIeeeControl); }

FpScope::~FpScope() {
  if (x87_changed_) restore_x87(x87_);
  set_control(saved_);
}

}  // namespace trueshade
