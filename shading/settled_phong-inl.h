// Codes of Phong terms under spot lights, settled as those of settled_codes-inl.h are: docs/arithmetic.md section 18.
// The power is of floats; the bound follows the highlight and the edge of the cone, lane by lane. Included once per SIMD
// target.
#if defined(TRUESHADE_SHADING_SETTLED_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SETTLED_PHONG_INL_H_
#undef TRUESHADE_SHADING_SETTLED_PHONG_INL_H_
#else
#define TRUESHADE_SHADING_SETTLED_PHONG_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "shading/settled_codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether codes of lights of this shape are settled here: Phong of the albedo's colour to the 60th, without a falloff.
template <class Shape>
constexpr bool settles_phong() {
  if constexpr (Shape::compiled && kLanes == kBlockPixels)
    return Shape::shape.falloff == Falloff::none && Shape::shape.order == TermOrder::factored &&
           Shape::shape.cone == Cone::smooth_penumbra && Shape::shape.diffuse == Diffuse::clamped &&
           Shape::shape.specular == Specular::phong && Shape::shape.source == SpecularSource::albedo &&
           Shape::shape.renormalize && !Shape::shape.specular_masked && Shape::shape.power == 60;
  return false;
}

/// A light as its codes are estimated: one cache line. Bounds are in units of 2^-14 of a code.
struct alignas(64) SettledSpot {
  float position[3], cut2;
  float color[3];  ///< times 255 / 256
  float axis[3], edge, slope;
  float away;    ///< what the cone's t may be off by
  float window;  ///< bound of what neither of the next is; above 2^13: nothing is settled
  float shine;   ///< the same of the highlight, a share of it
  float slant;   ///< and of the cone, by t - t^2 and what it multiplies
};

inline SettledSpot settled_spot(const ListedLight& listed) {
  const LightRow& row = *listed.light;
  SettledSpot out;
  out.cut2 = listed.cut2;
  float most = 0.0f, length2 = 0.0f;
  bool plain = row.slope >= 0.0f && row.slope <= 64.0f;
  for (int c = 0; c < 3; ++c) {
    plain = plain && row.color[c] >= 0.0f && row.color[c] <= 0.95f;
    most = std::max(most, row.color[c]), length2 += row.axis[c] * row.axis[c];
    out.position[c] = listed.position[c];
    out.color[c] = row.color[c] * (255.0f / 256.0f);
    out.axis[c] = row.axis[c];
  }
  const bool coned = row.kind == LightKind::coned;
  plain = plain && (!coned || length2 <= 1.0f + 0x1p-10f);
  out.edge = row.edge, out.slope = row.slope;
  const float unit = most * 0.25f;  // of 255 u
  out.away = (14.0f * row.slope + 6.0f) * 0x1p-24f;
  out.window = plain ? 40.0f * unit + 1.0f : 0x1p20f;
  out.shine = plain ? 3000.0f * unit : 0.0f;
  out.slant = plain && coned ? 90.0f * unit * row.slope : 0.0f;
  return out;
}

/// What the lights of a vector of pixels have in common beside PixelVector: 2 N . V.
HWY_INLINE VF twice_facing(const PixelVector& px) {
  const VF facing = dot3(px.n, px.v);
  return hn::Add(facing, facing);
}
HWY_INLINE MF plain_views(const PixelVector& px) { return hn::Le(dot3(px.v, px.v), hn::Set(DF(), 1.0f + 0x1p-10f)); }

/// Some pairs of a light and a vector of pixels, a step of each after the other.
template <size_t kMany, class Root = EstimatedRoot>
struct PhongPairs {
  const PixelVector* px[kMany];
  const VF* facing2[kMany];
  const SettledSpot* light[kMany];
  MF open[kMany];  ///< at first the pixels in question, then those that are not settled and may count

  /// What weigh() makes of the pairs.
  struct Weights {
    VF facing[kMany], weight[kMany], bound[kMany];  ///< N . D; what the colours are multiplied by; in units of 2^-14
    MF settled[kMany];                              ///< pixels that are estimated
  };

  template <bool kCone, class Shape>
  HWY_INLINE void weigh(const LightTerms<Shape>& terms, Weights& of) {
    const DF d;
    const VF one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    LightChain at[kMany];
    VF inverse[kMany], diffuse[kMany], shine[kMany];
    for (size_t k = 0; k < kMany; ++k) terms.place(*px[k], false, light[k]->position, at[k]);
    for (size_t k = 0; k < kMany; ++k) {
      open[k] = less_within(open[k], at[k].d2, hn::Set(d, light[k]->cut2));
      of.settled[k] =
          less_within(less_within(open[k], hn::Set(d, 0x1p-100f), at[k].d2), at[k].d2, hn::Set(d, 0x1p100f));
      inverse[k] = Root::reciprocal(at[k].d2);
    }
    for (size_t k = 0; k < kMany; ++k)
      inverse[k] = hn::Mul(hn::Mul(inverse[k], half),
                           hn::Sub(hn::Set(d, 3.0f), hn::Mul(at[k].d2, hn::Mul(inverse[k], inverse[k]))));
    for (size_t k = 0; k < kMany; ++k) {
      diffuse[k] = at_most(positive(hn::Mul(at[k].nl, inverse[k])), 1.0f);
      const VF seen = hn::Sub(hn::Mul(diffuse[k], *facing2[k]), hn::Mul(dot3(at[k].to_light, px[k]->v), inverse[k]));
      shine[k] = hn::Min(hn::Max(seen, half), one);  // less comes to less than 2^-60, and must not become denormal
    }
    power60(shine);
    for (size_t k = 0; k < kMany; ++k) {
      of.facing[k] = at[k].nl;
      of.weight[k] = hn::Add(diffuse[k], shine[k]);
      of.bound[k] = hn::Add(hn::Set(d, light[k]->window), hn::Mul(hn::Set(d, light[k]->shine), shine[k]));
      if constexpr (kCone) narrow(k, at[k], inverse[k], of.weight[k], of.bound[k], of.settled[k]);
    }
  }

  /// The estimate of 255 / 256 of a channel's term.
  HWY_INLINE VF estimate(size_t k, int c, VF weight) const {
    return hn::Mul(hn::Mul(px[k]->albedo[c], hn::Set(DF(), light[k]->color[c])), weight);
  }

  /// Adds the codes that are settled.
  template <bool kCone, class Shape>
  HWY_INLINE void settle(const LightTerms<Shape>& terms, SettledCodes* const out[kMany]) {
    const DF d;
    const DI di;
    Weights of;
    weigh<kCone>(terms, of);
    for (size_t k = 0; k < kMany; ++k) {
      MF& settled = of.settled[k];
      const auto near = hn::ConvertTo(di, of.bound[k]), nearer = hn::Add(near, near);
      hn::Vec<DI> t[3];
      for (int c = 0; c < 3; ++c) {
        const VF x = estimate(k, c, of.weight[k]);
        t[c] = hn::Add(hn::BitCast(di, hn::Add(x, hn::Set(d, 2.0f + 0x1p-9f))), near);
        settled = greater_within(settled, hn::And(t[c], hn::Set(di, (1 << kBelowCode) - 1)), nearer);
      }
      for (int c = 0; c < 3; ++c)
        out[k]->sum[c] = hn::Add(out[k]->sum[c], hn::IfThenElseZero(hn::RebindMask(di, settled),
                                                                  hn::ShiftRight<kBelowCode>(t[c])));
      const MF lit = less_within(settled, hn::Zero(d), of.facing[k]);
      out[k]->lit = hn::Add(out[k]->lit, hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1)));
      open[k] = hn::AndNot(settled, open[k]);
    }
  }

 private:
  static HWY_INLINE void power60(VF x[kMany]) {
    VF y[kMany];
    for (size_t k = 0; k < kMany; ++k) y[k] = hn::Mul(x[k], x[k]);
    for (size_t k = 0; k < kMany; ++k) x[k] = hn::Mul(y[k], x[k]);  // 3
    for (size_t k = 0; k < kMany; ++k) y[k] = hn::Mul(x[k], x[k]);
    for (size_t k = 0; k < kMany; ++k) y[k] = hn::Mul(y[k], y[k]);
    for (size_t k = 0; k < kMany; ++k) x[k] = hn::Mul(x[k], y[k]);  // 15
    for (size_t k = 0; k < kMany; ++k) x[k] = hn::Mul(x[k], x[k]);
    for (size_t k = 0; k < kMany; ++k) x[k] = hn::Mul(x[k], x[k]);
  }

  HWY_INLINE void narrow(size_t k, const LightChain& at, VF inverse, VF& weight, VF& bound, MF& settled) {
    const DF d;
    const SettledSpot& l = *light[k];
    VF axis[3];
    for (int c = 0; c < 3; ++c) axis[c] = hn::Set(d, l.axis[c]);
    const VF along = hn::Mul(dot3(at.to_light, axis), inverse);
    const VF place = hn::Mul(hn::Sub(along, hn::Set(d, l.edge)), hn::Set(d, l.slope));
    const VF t = at_most(positive(place), 1.0f), square = hn::Mul(t, t);
    bound = hn::Add(bound, hn::Mul(hn::Mul(hn::Set(d, l.slant), hn::Sub(t, square)), weight));
    weight = hn::Mul(weight, hn::Mul(square, hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t))));
    // Outside the cone for sure: nothing is open there, and nothing counts.
    open[k] = hn::AndNot(less_within(settled, place, hn::Set(d, -l.away)), open[k]);
    settled = less_within(settled, hn::Set(d, l.away), place);
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
