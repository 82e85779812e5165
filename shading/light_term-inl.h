// What one light adds to a vector of pixels: docs/arithmetic.md section 8. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_TERM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_TERM_INL_H_
#undef TRUESHADE_SHADING_LIGHT_TERM_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_TERM_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces.h"
#include "scenes/light_model.h"
#include "shading/light_table.h"
#include "shading/specular-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

HWY_INLINE VF dot3(const VF a[3], const VF b[3]) {
  return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

/// 1 / sqrt(l2), or 0 for a zero vector.
HWY_INLINE VF inverse_length(VF l2) {
  const DF d;
  return hn::IfThenElseZero(hn::Gt(l2, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), hn::Sqrt(l2)));
}

/// What the lights of one vector of pixels have in common.
struct PixelVector {
  MF covered;
  VF p[3], n[3], v[3], albedo[3];
};

HWY_INLINE PixelVector load_pixels(const SurfaceTile& s, int i, const LightModel& model, const float eye[3]) {
  const DF d;
  PixelVector out;
  out.covered = hn::RebindMask(d, hn::MaskFromVec(hn::BitCast(d, hn::Load(DI(), s.covered + i))));
  for (int c = 0; c < 3; ++c) {
    out.p[c] = hn::Load(d, s.plane[kPosition + c] + i);
    out.n[c] = hn::Load(d, s.plane[kNormal + c] + i);
    out.albedo[c] = hn::Load(d, s.plane[kAlbedo + c] + i);
    out.v[c] = hn::Sub(hn::Set(d, eye[c]), out.p[c]);
  }
  const VF toward = inverse_length(dot3(out.v, out.v));
  for (int c = 0; c < 3; ++c) out.v[c] = hn::Mul(out.v[c], toward);
  if (model.renormalize) {
    const VF unit = inverse_length(dot3(out.n, out.n));
    for (int c = 0; c < 3; ++c) out.n[c] = hn::Mul(out.n[c], unit);
  }
  return out;
}

/// pow(max(N.H, 0), shininess) by way of its square where the exponent is even.
HWY_INLINE VF specular_term(const PixelVector& px, const VF l[3], const LightModel& model, const Exponent& exponent) {
  const DF d;
  VF h[3];
  for (int c = 0; c < 3; ++c) h[c] = hn::Add(l[c], px.v[c]);
  const VF h2 = dot3(h, h), nh = dot3(px.n, h), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF t = hn::IfThenElseZero(hn::Gt(nh, zero), nh);
  const VF quotient = exponent.squared ? hn::Div(hn::Mul(t, t), h2) : hn::Div(t, hn::Sqrt(h2));
  VF x = hn::IfThenElseZero(hn::Gt(h2, zero), quotient);
  if (model.renormalize) x = hn::IfThenElse(hn::Gt(x, one), one, x);
  return rounded_power(x, exponent);
}

/// What one light does to a vector of pixels.
struct LightTerm {
  MF adds;      ///< pixels whose sums it changes; `color` means nothing elsewhere
  MF lit;       ///< pixels it is in range of and that face it
  VF color[3];  ///< what it adds
};

/// Terms of the lights of a table under one model (docs/arithmetic.md section 8).
struct LightTerms {
  const LightTable& lights;
  const LightModel& model;
  const Exponent exponent;

  HWY_INLINE LightTerm ambient(const PixelVector& px, size_t light) const {
    const DF d;
    LightTerm out;
    out.adds = px.covered;
    out.lit = hn::Lt(hn::Zero(d), hn::Zero(d));
    for (int k = 0; k < 3; ++k) out.color[k] = hn::Mul(px.albedo[k], hn::Set(d, lights.color[k][light]));
    return out;
  }

  HWY_INLINE VF falloff(VF distance, size_t light) const {
    const DF d;
    const VF one = hn::Set(d, 1.0f);
    if (model.falloff == Falloff::linear_range) {
      const VF f = hn::Sub(one, hn::Div(distance, hn::Set(d, lights.range[light])));
      return hn::IfThenElseZero(hn::Gt(f, hn::Zero(d)), f);
    }
    const VF linear = hn::Add(one, hn::Mul(hn::Set(d, lights.k1[light]), distance));
    return hn::Div(one, hn::Add(linear, hn::Mul(hn::Mul(hn::Set(d, lights.k2[light]), distance), distance)));
  }

  /// Where `adds` is empty nothing else is computed.
  HWY_INLINE LightTerm operator()(const PixelVector& px, size_t light) const {
    const DF d;
    const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    if (lights.type[light] == LightType::ambient) return ambient(px, light);
    const bool directional = lights.type[light] == LightType::directional;
    VF to_light[3];
    for (int c = 0; c < 3; ++c) {
      const VF place = hn::Set(d, lights.position[c][light]);
      to_light[c] = directional ? place : hn::Sub(place, px.p[c]);
    }
    const VF d2 = dot3(to_light, to_light), raw_nl = dot3(px.n, to_light);
    const MF in_range = directional ? px.covered : hn::And(px.covered, hn::Lt(d2, hn::Set(d, lights.cut2[light])));
    LightTerm out;
    out.lit = hn::And(in_range, hn::Gt(raw_nl, zero));
    out.adds = model.specular_masked ? out.lit : in_range;
    if (hn::AllFalse(d, out.adds)) return out;

    VF strength = one, nl = raw_nl;
    if (!directional) {
      const VF distance = hn::Sqrt(d2);
      const VF inverse = hn::IfThenElseZero(hn::Gt(d2, zero), hn::Div(one, distance));
      nl = hn::Mul(raw_nl, inverse);
      for (int c = 0; c < 3; ++c) to_light[c] = hn::Mul(to_light[c], inverse);
      strength = falloff(distance, light);
    }
    const VF c = hn::IfThenElseZero(hn::Gt(nl, zero), nl);
    const VF s = specular_term(px, to_light, model, exponent);
    for (int k = 0; k < 3; ++k) {
      const VF color = hn::Set(d, lights.color[k][light]), ks = hn::Set(d, model.specular_color[k]);
      if (model.order == TermOrder::factored) {
        out.color[k] = hn::Mul(hn::Add(hn::Mul(px.albedo[k], c), hn::Mul(ks, s)), hn::Mul(color, strength));
      } else {
        const VF diffuse = hn::Mul(hn::Mul(hn::Mul(c, px.albedo[k]), color), strength);
        out.color[k] = hn::Add(diffuse, hn::Mul(hn::Mul(hn::Mul(color, s), ks), strength));
      }
    }
    return out;
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
