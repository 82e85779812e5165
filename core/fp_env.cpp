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
#else
constexpr uint64_t kIeeeControl = 0;  // FPCR: no traps, nearest even, no FZ, no default NaN
uint64_t control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void set_control(uint64_t value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#endif

}  // namespace

FpScope::FpScope() : saved_(control()) { set_control(kIeeeControl); }
FpScope::~FpScope() { set_control(saved_); }

}  // namespace trueshade
