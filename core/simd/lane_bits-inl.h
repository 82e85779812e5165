// Masks as words of bits. Included once per SIMD target.
#if defined(TRUESHADE_CORE_SIMD_LANE_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_CORE_SIMD_LANE_BITS_INL_H_
#undef TRUESHADE_CORE_SIMD_LANE_BITS_INL_H_
#else
#define TRUESHADE_CORE_SIMD_LANE_BITS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A bit for each lane of a mask, 0 above. Instead of hn::CountTrue() and hn::FindFirstTrue() too, which widen a mask
/// by themselves: g++ 12 may spill a mask as 8 or 16 bits and read the place back as 32, whose upper ones are what lay
/// there (find_triangles() by -O1 never ended). Taken from the register by an instruction that it cannot split, they
/// are 0; tests/instructions.sh looks for such places.
template <class D>
HWY_INLINE uint32_t lane_bits([[maybe_unused]] D d, hn::Mask<D> mask) {
#if HWY_TARGET == HWY_AVX3
  static_assert(hn::MaxLanes(D()) >= 8 && hn::MaxLanes(D()) <= 32);  // below that masks have bits that mean nothing
#if HWY_COMPILER_GCC_ACTUAL
  uint32_t bits;
  if constexpr (sizeof(mask.raw) == 1) asm("kmovb %1, %0" : "=r"(bits) : "k"(mask.raw));
  if constexpr (sizeof(mask.raw) == 2) asm("kmovw %1, %0" : "=r"(bits) : "k"(mask.raw));
  if constexpr (sizeof(mask.raw) == 4) asm("kmovd %1, %0" : "=r"(bits) : "k"(mask.raw));
  return bits;
#else
  return mask.raw;
#endif
#else
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  uint32_t bits;
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits;
#endif
}

/// Lanes of a mask that are set.
template <class D>
HWY_INLINE int lane_count(D d, hn::Mask<D> mask) {
  return std::popcount(lane_bits(d, mask));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
