// x^p for vectors, evaluated in double and rounded once. Included once per SIMD target. docs/arithmetic.md section 9.
#if defined(TRUESHADE_SHADING_SPECULAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SPECULAR_INL_H_
#undef TRUESHADE_SHADING_SPECULAR_INL_H_
#else
#define TRUESHADE_SHADING_SPECULAR_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/power.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// pow(x, exponent) of x >= 0, in double, rounded once.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> rounded_power(hn::Vec<hn::ScalableTag<float>> x, const Exponent& exponent) {
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> dh;
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  hn::Store(x, d, lane);
  for (size_t i = 0; i < hn::Lanes(d); i += hn::Lanes(dd)) {
    if (exponent.integer < 0) {
      for (size_t k = i; k < i + hn::Lanes(dd); ++k) lane[k] = float(power(double(lane[k]), exponent.value));
      continue;
    }
    const auto base = hn::PromoteTo(dd, hn::Load(dh, lane + i));
    auto result = exponent.integer == 0 ? hn::Set(dd, 1.0) : base;
    for (int bit = exponent.top_bit - 1; bit >= 0; --bit) {
      result = hn::Mul(result, result);
      if ((exponent.integer >> bit) & 1) result = hn::Mul(result, base);
    }
    hn::Store(hn::DemoteTo(dh, result), dh, lane + i);
  }
  return hn::Load(d, lane);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
