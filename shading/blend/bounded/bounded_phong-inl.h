// Codes of Phong terms under spot lights, proved as those of bounded_codes-inl.h are: docs/proofs.md section 18.
// The power is of floats; the bound follows the highlight and the edge of the cone, lane by lane. Included once per
// SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PHONG_INL_H_
#undef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PHONG_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_PHONG_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "shading/blend/bounded/bounded_codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The shape whose codes section 18 bounds: Phong of the albedo's colour to the 60th, without a falloff.
struct SpotPhong {
  static constexpr LightShape shape = kSpotPhong;
  static constexpr bool compiled = true;
};

/// A light as its codes are estimated: one cache line. Bounds are in units of 2^-14 of a code.
struct alignas(64) BoundedSpot {
  float position[3], cut2;
  float color[3];  ///< times 255 / 256
  float axis[3], edge, slope;
  float away;    ///< what the cone's t may be off by
  float window;  ///< bound of what neither of the next is; above 2^13: nothing is proved
  float shine;   ///< the same of the highlight, a share of it
  float slant;   ///< and of the cone, by t - t^2 and what it multiplies

  void set(const ListedLight& listed);
};

/// The same in all lanes.
struct SpotLanes {
  VF position[3], cut2, color[3], axis[3], edge, slope, away, window, shine, slant;

  HWY_INLINE explicit SpotLanes(const BoundedSpot& light) {
    const DF d;
    for (int c = 0; c < 3; ++c) {
      position[c] = hn::Set(d, light.position[c]), color[c] = hn::Set(d, light.color[c]);
      axis[c] = hn::Set(d, light.axis[c]);
    }
    cut2 = hn::Set(d, light.cut2), edge = hn::Set(d, light.edge), slope = hn::Set(d, light.slope);
    away = hn::Set(d, light.away), window = hn::Set(d, light.window), shine = hn::Set(d, light.shine);
    slant = hn::Set(d, light.slant);
  }
};

inline void BoundedSpot::set(const ListedLight& listed) {
  const LightRow& row = *listed.light;
  cut2 = listed.cut2;
  float most = 0.0f, length2 = 0.0f;
  bool in_range = row.slope >= 0.0f && row.slope <= 64.0f;
  for (int c = 0; c < 3; ++c) {
    in_range = in_range && row.color[c] >= 0.0f && row.color[c] <= 0.95f;
    most = std::max(most, row.color[c]), length2 += row.axis[c] * row.axis[c];
    position[c] = listed.position[c];
    color[c] = row.color[c] * (255.0f / 256.0f);
    axis[c] = row.axis[c];
  }
  const bool coned = row.kind == LightKind::coned;
  in_range = in_range && (!coned || length2 <= 1.0f + 0x1p-10f);
  edge = row.edge, slope = row.slope;
  const float unit = most * 0.25f;  // of 255 u
  away = (14.0f * row.slope + 6.0f) * 0x1p-24f;
  window = in_range ? 40.0f * unit + 1.0f : 0x1p20f;
  shine = in_range ? 3000.0f * unit : 0.0f;
  slant = in_range && coned ? 90.0f * unit * row.slope : 0.0f;
}

/// What the lights of a vector of pixels have in common beside PixelVector: 2 N . V.
HWY_INLINE VF twice_facing(const PixelVector& px) {
  const VF facing = dot3(px.n, px.v);
  return hn::Add(facing, facing);
}
HWY_INLINE MF views_in_proof_range(const PixelVector& px) {
  return hn::Le(dot3(px.v, px.v), hn::Set(DF(), 1.0f + 0x1p-10f));
}

/// Some pairs of one light and a vector of pixels, a step of each after the other. kCone: of lights that have a cone.
template <size_t kMany, bool kCone, class Root = EstimatedRoot>
struct PhongPairs {
  using Light = BoundedSpot;
  using Lanes = SpotLanes;
  static constexpr size_t kCount = kMany;
  static constexpr bool kSpecular = true;
  static constexpr CountedLights kCounted = CountedLights::separately;
  const PixelVector* px[kMany];
  const VF* facing2[kMany];
  MF undecided[kMany];  ///< at first the pixels in question, then those that may count and are not proved

  /// What weigh() makes of the pairs.
  struct Weights {
    VF facing[kMany], weight[kMany], bound[kMany];  ///< N . D; what the colours are multiplied by; in units of 2^-14
    MF estimated[kMany];                            ///< pixels that are estimated
  };

  HWY_INLINE void weigh(const Lanes& light, Weights& of) {
    const DF d;
    const VF one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    VF to_light[kMany][3], d2[kMany], inverse[kMany], diffuse[kMany], shine[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      for (int c = 0; c < 3; ++c) to_light[k][c] = hn::Sub(light.position[c], px[k]->p[c]);
      of.facing[k] = dot3(px[k]->n, to_light[k]), d2[k] = dot3(to_light[k], to_light[k]);
    }
    for (size_t k = 0; k < kMany; ++k) {
      undecided[k] = less_within(undecided[k], d2[k], light.cut2);
      of.estimated[k] =
          less_within(less_within(undecided[k], hn::Set(d, 0x1p-100f), d2[k]), d2[k], hn::Set(d, 0x1p100f));
      inverse[k] = Root::reciprocal(d2[k]);
    }
    for (size_t k = 0; k < kMany; ++k)
      inverse[k] = hn::Mul(hn::Mul(inverse[k], half),
                           hn::Sub(hn::Set(d, 3.0f), hn::Mul(d2[k], hn::Mul(inverse[k], inverse[k]))));
    for (size_t k = 0; k < kMany; ++k) {
      diffuse[k] = at_most(positive(hn::Mul(of.facing[k], inverse[k])), 1.0f);
      const VF seen = hn::Sub(hn::Mul(diffuse[k], *facing2[k]), hn::Mul(dot3(to_light[k], px[k]->v), inverse[k]));
      shine[k] = hn::Min(hn::Max(seen, half), one);  // less comes to less than 2^-60, and must not become denormal
    }
    power60(shine);
    for (size_t k = 0; k < kMany; ++k) {
      of.weight[k] = hn::Add(diffuse[k], shine[k]);
      of.bound[k] = hn::Add(light.window, hn::Mul(light.shine, shine[k]));
      if constexpr (kCone) narrow(light, k, to_light[k], inverse[k], of);
    }
  }

  /// The estimate of 255 / 256 of a channel's term.
  HWY_INLINE VF estimate(const Lanes& light, size_t k, int c, VF weight) const {
    return hn::Mul(hn::Mul(px[k]->albedo[c], light.color[c]), weight);
  }

  /// Adds the codes that bounds prove.
  HWY_INLINE void decide(const Lanes& light, Weights& of, BoundedCodes* const out[kMany]) {
    const DF d;
    const DI di;
    for (size_t k = 0; k < kMany; ++k) {
      MF& proved = of.estimated[k];
      const auto near = hn::ConvertTo(di, of.bound[k]), nearer = hn::Add(near, near);
      hn::Vec<DI> t[3];
      for (int c = 0; c < 3; ++c) {
        const VF x = estimate(light, k, c, of.weight[k]);
        t[c] = hn::Add(hn::BitCast(di, hn::Add(x, hn::Set(d, 2.0f + 0x1p-9f))), near);
        proved = greater_within(proved, hn::And(t[c], hn::Set(di, (1 << kBelowCode) - 1)), nearer);
      }
      out[k]->add(proved, t);
      const MF lit = less_within(proved, hn::Zero(d), of.facing[k]);
      out[k]->lit = hn::Add(out[k]->lit, hn::IfThenElseZero(hn::RebindMask(di, lit), hn::Set(di, 1)));
      undecided[k] = hn::AndNot(proved, undecided[k]);
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

  HWY_INLINE void narrow(const Lanes& light, size_t k, const VF to_light[3], VF inverse, Weights& of) {
    const DF d;
    const VF along = hn::Mul(dot3(to_light, light.axis), inverse);
    const VF ramp = hn::Mul(hn::Sub(along, light.edge), light.slope);
    const VF t = at_most(positive(ramp), 1.0f), square = hn::Mul(t, t);
    of.bound[k] = hn::Add(of.bound[k], hn::Mul(hn::Mul(light.slant, hn::Sub(t, square)), of.weight[k]));
    of.weight[k] = hn::Mul(of.weight[k], hn::Mul(square, hn::Sub(hn::Set(d, 3.0f), hn::Add(t, t))));
    // Outside the cone for sure: nothing is undecided there, and nothing counts.
    undecided[k] = hn::AndNot(less_within(of.estimated[k], ramp, hn::Neg(light.away)), undecided[k]);
    of.estimated[k] = less_within(of.estimated[k], light.away, ramp);
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
