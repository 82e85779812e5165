// Light that is added to target pixels: the accumulator of draws whose blending adds. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_ADDED_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_ADDED_LIGHT_INL_H_
#undef TRUESHADE_SHADING_BLEND_ADDED_LIGHT_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_ADDED_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/blend/blend-inl.h"
#include "shading/blend/blend_draw-inl.h"
#include "shading/light/light_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The code of fixed point, up to `largest`, that a light adds to a channel.
HWY_INLINE VF added_code(VF x, MF adds, VF largest) {
  const DF d;
  const MF counts = hn::And(adds, hn::Gt(x, hn::Zero(d)));  // and is a number
  return hn::IfThenElseZero(counts, hn::Round(hn::Mul(hn::Min(x, hn::Set(d, 1.0f)), largest)));
}

/// Adds values to R, G and B in their stored form, where the plan sums values.
inline HWY_NOINLINE void sum_values(const BlendPlan& plan, const VF source[3], VF stored[3]) {
  for (int c = 0; c < 3; ++c) stored[c] = summed_values(plan, source[c], stored[c], c);
}

/// A vector of target pixels in registers, onto which light is added. Where a light adds nothing nothing changes, and
/// alpha is not written. With kCodes the target is fixed point and codes are added (docs/gl_rules.md section 10, point
/// 4). Such sums are exact in float32, so saturate() may clamp them to the largest code after many lights.
template <bool kCodes>
struct AddedLight {
  const BlendPlan* plan;
  float largest[3];
  VF stored[4];
  hn::Vec<DI> lights;
  uint64_t evaluated = 0;

  AddedLight() = default;
  AddedLight(const BlendPlan& blend_plan, const StoredPixels& pixels) : plan(&blend_plan), lights(pixels.lights) {
    for (int c = 0; c < 4; ++c) stored[c] = pixels.stored[c];
    for (int c = 0; c < 3; ++c) largest[c] = plan->largest(c);
  }

  template <class Terms>
  HWY_INLINE void add(const Terms& terms, const PixelVector& px, const LightTerm& term) {
    const DF d;
    if constexpr (kCodes) {  // a clamped result is clamped again
      for (int c = 0; c < 3; ++c) {
        const VF x = terms.tinted(px, term.color[c], c);
        stored[c] = hn::Add(stored[c], added_code(x, term.adds, hn::Set(d, largest[c])));
      }
    } else {
      VF source[4], next[4] = {stored[0], stored[1], stored[2], stored[3]};
      for (int c = 0; c < 3; ++c) source[c] = terms.finished(px, term.color[c], c);
      source[3] = hn::Zero(d);
      if (plan->sums_values)
        sum_values(*plan, source, next);
      else
        blend_out_of_line(*plan, source, next);
      for (int c = 0; c < 3; ++c) stored[c] = hn::IfThenElse(term.adds, next[c], stored[c]);
    }
  }
  HWY_INLINE void saturate() {
    static_assert((kMostHits + 1) * 65535 < (1 << 24));
    if constexpr (kCodes)
      for (int c = 0; c < 3; ++c) stored[c] = lesser(stored[c], hn::Set(DF(), largest[c]));
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
