#include "tests/fp_modes/fp_mode.h"

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace trueshade {
namespace {

#if defined(__x86_64__)
constexpr uint32_t kRoundingBits[] = {0, 1, 2, 3};  // MXCSR bits 13 and 14, x87 control word bits 10 and 11
constexpr uint32_t kFlushes = 0x8040, kMasks = 0x1f80, kX87Masks = 0x3f, kX87Precision = 0x300;

uint16_t x87_control() {
  uint16_t word;
  asm volatile("fnstcw %0" : "=m"(word));
  return word;
}

void set(uint32_t mxcsr, uint16_t x87) {
  asm volatile("fnclex\n\tfldcw %0" : : "m"(x87));
  _mm_setcsr(mxcsr);
}
#else
constexpr uint64_t kRoundingBits[] = {0, 2, 1, 3};  // FPCR bits 22 and 23
constexpr uint64_t kFlushes = uint64_t(1) << 24, kTraps = 0x9f00;

uint64_t control() {
  uint64_t value;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
#endif

constexpr const char* kRoundingNames[] = {"nearest", "downward", "upward", "toward zero"};

}  // namespace

std::vector<FpMode> all_fp_modes() {
  std::vector<FpMode> modes;
  for (const Rounding rounding : {Rounding::nearest, Rounding::downward, Rounding::upward, Rounding::toward_zero})
    for (const bool flushes : {false, true})
      for (const bool traps : {false, true}) modes.push_back({rounding, flushes, traps});
  return modes;
}

std::string text_of(const FpMode& mode) {
  return std::string(kRoundingNames[size_t(mode.rounding)]) + (mode.flushes ? ", flushing" : "") +
         (mode.traps ? ", trapping" : "");
}

#if defined(__x86_64__)
void set_fp_mode(const FpMode& mode) {
  const uint32_t rounding = kRoundingBits[size_t(mode.rounding)];
  set(rounding << 13 | (mode.flushes ? kFlushes : 0) | (mode.traps ? 0 : kMasks),
      uint16_t(rounding << 10 | kX87Precision | (mode.traps ? 0 : kX87Masks)));
}

FpMode current_fp_mode() {
  const uint32_t mxcsr = _mm_getcsr();
  const uint16_t x87 = x87_control();
  FpMode mode{Rounding((mxcsr >> 13) & 3), (mxcsr & kFlushes) == kFlushes, (mxcsr & kMasks) == 0};
  const bool x87_traps = (x87 & kX87Masks) == 0;
  // Where the two units differ, no mode of all_fp_modes() is in force: the flag that nobody set tells.
  if (((x87 >> 10) & 3u) != uint32_t(mode.rounding) || x87_traps != mode.traps) mode.flushes = !mode.flushes;
  return mode;
}
#else
void set_fp_mode(const FpMode& mode) {
  const uint64_t value = kRoundingBits[size_t(mode.rounding)] << 22 | (mode.flushes ? kFlushes : 0) |
                         (mode.traps ? kTraps : 0);
  asm volatile("msr fpcr, %0" : : "r"(value));
}

FpMode current_fp_mode() {
  const uint64_t value = control();
  FpMode mode;
  for (const Rounding rounding : {Rounding::nearest, Rounding::downward, Rounding::upward, Rounding::toward_zero})
    if (kRoundingBits[size_t(rounding)] == ((value >> 22) & 3)) mode.rounding = rounding;
  mode.flushes = (value & kFlushes) != 0;
  mode.traps = (value & kTraps) != 0;
  return mode;
}
#endif

}  // namespace trueshade
