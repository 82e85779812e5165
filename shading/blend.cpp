#include "shading/blend.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/blend.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shading/blend-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// [0, 1]; NaN gives 0.
HWY_INLINE VF clamped(VF x) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  const VF positive = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);
  return hn::IfThenElse(hn::Gt(positive, one), one, positive);
}

HWY_INLINE VF with_one_nan(VF x) {
  const DF d;
  return hn::IfThenElse(hn::Eq(x, x), x, hn::BitCast(d, hn::Set(DU(), 0x7FC00000u)));
}

HWY_INLINE void load_codes(const BlendState& state, const float* const source[4], float* const stored[4], size_t i,
                           BlendInputs& in) {
  const DF d;
  in.one = hn::Set(d, 255.0f);
  for (int c = 0; c < 4; ++c) {
    in.source[c] = unorm8_code(hn::Load(d, source[c] + i));
    in.destination[c] = hn::Load(d, stored[c] + i);
    in.constant[c] = unorm8_code(hn::Set(d, state.constant[size_t(c)]));
  }
}

HWY_INLINE void load_values(const BlendState& state, bool unorm, const float* const source[4], float* const stored[4],
                            size_t i, BlendInputs& in) {
  const DF d;
  in.one = hn::Set(d, 1.0f);
  for (int c = 0; c < 4; ++c) {
    const VF s = hn::Load(d, source[c] + i), k = hn::Set(d, state.constant[size_t(c)]), p = hn::Load(d, stored[c] + i);
    in.source[c] = unorm ? clamped(s) : s;
    in.constant[c] = unorm ? clamped(k) : k;
    in.destination[c] = unorm ? hn::Div(p, hn::Set(d, 255.0f)) : p;
  }
}

/// Fixed point: `ideal` blends values and rounds once, except that light upon light adds codes; llvmpipe blends codes.
void blend_unorm8(const BlendState& state, NumericProfile profile, const float* const source[4], float* const stored[4],
                  size_t count) {
  const DF d;
  const BlendPlan plan = blend_plan(state, profile, Format::rgba8);
  BlendInputs in;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const bool codes = profile != NumericProfile::ideal;
    if (codes)
      load_codes(state, source, stored, i, in);
    else
      load_values(state, true, source, stored, i, in);
    in.source_alpha = in.source[3];
    VF out[4];
    for (int c = 0; c < 4; ++c) {
      if (!state.enabled)
        out[c] = unorm8_code(hn::Load(d, source[c] + i));
      else if (codes)
        out[c] = blended_codes(plan, c, in);
      else if (plan.group(c).term == kAccumulate)
        out[c] = lesser(hn::Add(hn::Load(d, stored[c] + i), unorm8_code(in.source[c])), hn::Set(d, 255.0f));
      else
        out[c] = unorm8_code(blended_values(plan, c, in));
    }
    for (int c = 0; c < 4; ++c)
      if (state.mask[size_t(c)]) hn::Store(out[c], d, stored[c] + i);
  }
}

void blend_floating(const BlendState& state, const BlendTarget& target, const float* const source[4],
                    float* const stored[4], size_t count) {
  const DF d;
  const BlendPlan plan = blend_plan(state, target.profile, target.format);
  BlendInputs in;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    load_values(state, false, source, stored, i, in);
    in.source_alpha = flushed(plan, in.source[3]);
    VF out[4];
    for (int c = 0; c < 4; ++c) {
      const VF value = state.enabled ? blended_values(plan, c, in) : in.source[c];
      out[c] = with_one_nan(target.format == Format::rgba16f ? rounded_to_half(value, target.half_round) : value);
    }
    for (int c = 0; c < 4; ++c)
      if (state.mask[size_t(c)]) hn::Store(out[c], d, stored[c] + i);
  }
}

void blend_pixels_simd(const BlendState& state, const BlendTarget& target, const float* const source[4],
                       float* const stored[4], size_t count) {
  if (info(target.format).number_class == NumberClass::unorm)
    blend_unorm8(state, target.profile, source, stored, count);
  else
    blend_floating(state, target, source, stored, count);
}

void fetch_pixels_simd(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count) {
  const DF d;
  const bool unorm = info(target.format).number_class == NumberClass::unorm;
  for (int c = 0; c < 4; ++c)
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      const VF held = hn::Load(d, stored[c] + i);
      hn::Store(unorm ? unorm8_value(held, target.profile) : held, d, values[c] + i);
    }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(blend_pixels_simd);
HWY_EXPORT(fetch_pixels_simd);

void blend_pixels(const BlendState& state, const BlendTarget& target, const float* const source[4],
                  float* const stored[4], size_t count) {
  HWY_DYNAMIC_DISPATCH(blend_pixels_simd)(state, target, source, stored, count);
}

void fetch_pixels(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count) {
  HWY_DYNAMIC_DISPATCH(fetch_pixels_simd)(target, stored, values, count);
}
}  // namespace trueshade
#endif  // HWY_ONCE
