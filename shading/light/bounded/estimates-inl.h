// Estimates whose bits differ between CPUs, and comparisons within a mask, for code that proves its results by bounds.
// Comparisons within a mask are one instruction of AVX-512, which Highway does not name. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_BOUNDED_ESTIMATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_BOUNDED_ESTIMATES_INL_H_
#undef TRUESHADE_SHADING_LIGHT_BOUNDED_ESTIMATES_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_BOUNDED_ESTIMATES_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/light/power-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lanes of `mask` in which a has one of the bits.
HWY_INLINE MF has_any(MF mask, hn::Vec<DI> a, hn::Vec<DI> bits) {
#if HWY_TARGET <= HWY_AVX3
  return MF{_mm512_mask_test_epi32_mask(mask.raw, a.raw, bits.raw)};
#else
  return hn::And(mask, hn::RebindMask(DF(), hn::Ne(hn::And(a, bits), hn::Zero(DI()))));
#endif
}
/// Lanes of `mask` in which a > b.
HWY_INLINE MF greater_within(MF mask, hn::Vec<DI> a, hn::Vec<DI> b) {
#if HWY_TARGET <= HWY_AVX3
  return MF{_mm512_mask_cmpgt_epi32_mask(mask.raw, a.raw, b.raw)};
#else
  return hn::And(mask, hn::RebindMask(DF(), hn::Gt(a, b)));
#endif
}
/// Lanes of `mask` in which a < b.
HWY_INLINE MF less_within(MF mask, VF a, VF b) {
#if HWY_TARGET <= HWY_AVX3
  return MF{_mm512_mask_cmp_ps_mask(mask.raw, a.raw, b.raw, _CMP_LT_OQ)};
#else
  return hn::And(mask, hn::Lt(a, b));
#endif
}

/// Whether the CPU's estimate of 1 / sqrt is at most 1.5 * 2^-12 off as a share of it; that of targets that emulate
/// vectors is not.
constexpr bool kEstimatesRoots = HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;

/// 1 / sqrt(x) as the CPU estimates it, with whichever bits: with AVX-512 at most 2^-14 off as a share of it.
struct EstimatedRoot {
  static HWY_INLINE VF reciprocal(VF x) { return hn::ApproximateReciprocalSqrt(x); }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
