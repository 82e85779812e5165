// How light falls off with distance and out of its cone: docs/arithmetic.md section 8. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_FALLOFF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_FALLOFF_INL_H_
#undef TRUESHADE_SHADING_LIGHT_FALLOFF_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_FALLOFF_INL_H_
#endif

#include <hwy/highway.h>

#include "shading/light/light_table.h"
#include "shading/light/power-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kLargestFalloff = 1e18f;

// x86 has instructions that choose as these comparisons do, NaN and -0 included, behind Max and Min of more than a
// lane; elsewhere these make other choices.
constexpr bool kMaxTakesSecond = HWY_ARCH_X86 && hn::MaxLanes(DF()) > 1;

HWY_INLINE VF positive(VF x) {
  const VF zero = hn::Zero(DF());
  if constexpr (kMaxTakesSecond) return hn::Max(x, zero);
  return hn::IfThenElseZero(hn::Gt(x, zero), x);
}

HWY_INLINE VF at_most(VF x, float most) {
  const VF limit = hn::Set(DF(), most);
  if constexpr (kMaxTakesSecond) return hn::Min(limit, x);
  return hn::IfThenElse(hn::Gt(x, limit), limit, x);
}

/// Of a point or spot light, at `distance` with its square and its reciprocal (0 at 0); means nothing where the square
/// is not below the light's cut.
HWY_INLINE VF falloff_of(Falloff falloff, const LightRow& light, VF distance, VF d2, VF inverse) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  switch (falloff) {
    case Falloff::none:
      return one;
    case Falloff::linear_range:  // the light's cut, LightRow::cut2, is where it falls to 0
    case Falloff::linear:
      return hn::Sub(one, hn::Div(distance, hn::Set(d, light.range)));
    case Falloff::quadratic:
    case Falloff::attenuation: {
      const VF k0 = falloff == Falloff::quadratic ? one : hn::Set(d, light.k0);
      const VF linear = hn::Add(k0, hn::Mul(hn::Set(d, light.k1), distance));
      const VF square = hn::Mul(hn::Mul(hn::Set(d, light.k2), distance), distance);
      const VF f = hn::Div(one, hn::Add(linear, square));
      return falloff == Falloff::quadratic ? f : at_most(f, kLargestFalloff);
    }
    case Falloff::inverse_square: {
      const VF u = hn::Div(d2, hn::Set(d, light.range2));
      const VF window = positive(hn::Sub(one, hn::Mul(u, u)));
      return hn::Mul(window, at_most(hn::Mul(inverse, inverse), kLargestFalloff));
    }
  }
  return one;
}

/// Of a spot light whose kind is `coned`; to_light: L, of unit length.
HWY_INLINE VF cone_of(Cone cone, const LightRow& light, const VF to_light[3]) {
  const DF d;
  VF axis[3];
  for (int c = 0; c < 3; ++c) axis[c] = hn::Set(d, light.axis[c]);
  const VF cosine =
      hn::Add(hn::Add(hn::Mul(to_light[0], axis[0]), hn::Mul(to_light[1], axis[1])), hn::Mul(to_light[2], axis[2]));
  const VF edge = hn::Set(d, light.edge), slope = hn::Set(d, light.slope);
  switch (cone) {
    case Cone::none:
      return hn::Set(d, 1.0f);
    case Cone::smooth_cutoff:
    case Cone::smooth_penumbra: {
      const VF t = at_most(positive(hn::Mul(hn::Sub(cosine, edge), slope)), 1.0f);
      return hn::Mul(hn::Mul(t, t), hn::Sub(hn::Set(d, 3.0f), hn::Mul(hn::Set(d, 2.0f), t)));
    }
    case Cone::exponent:
      return hn::IfThenElseZero(hn::Ge(cosine, edge), rounded_power<-1>(positive(cosine), light.spot_exponent));
    case Cone::squared_penumbra: {
      const VF t = at_most(positive(hn::Add(hn::Mul(cosine, slope), edge)), 1.0f);
      return hn::Mul(t, t);
    }
  }
  return hn::Set(d, 1.0f);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
