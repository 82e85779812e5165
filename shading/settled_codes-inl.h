// Codes of one light's term in fixed point, from estimates of 1 / sqrt with a bound of the error: a code that no value
// within the bound changes is the term's own (Ziv, Fast evaluation of elementary mathematical functions with correctly
// rounded last bit, 1991); the other pixels of a pair are left to the term itself. The proof is docs/arithmetic.md
// section 17; it asks 2^-14 of the estimate, whose bits differ between CPUs. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SETTLED_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SETTLED_CODES_INL_H_
#undef TRUESHADE_SHADING_SETTLED_CODES_INL_H_
#else
#define TRUESHADE_SHADING_SETTLED_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "shading/light_term-inl.h"
#include "shading/regions-inl.h"
#include "shading/tile_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A value x of 8 bits is placed as the float t = 2 + x / 256 + 1 / 512 + e / 2^22, in [2, 4): its bits are 2^30, the
// code by 2^14, and what x lies above the border below, plus e, by units of 2^-14. Where that is less than 2 e a border
// is near. Sums of t's upper bits hold a count of lights above 16 bits of codes.
constexpr int kBelowCode = 14;
constexpr size_t kCodesAtOnce = 128;  // of at most 511 each, as sums of 16 bits hold
static_assert(kCodesAtOnce * 511 < 65536);

/// A light as its codes are estimated: one cache line.
struct alignas(64) SettledLight {
  float position[3], cut2;
  float color[3];    ///< times 255 / 512
  float half_share;  ///< 0.5 / range
  int32_t bias[4];   ///< 2 + 1 / 512 + e / 2^22, a float
  int32_t clear[4];  ///< bits of t, one of which is set where no border is near; 0: nothing is settled
};

/// The least e, a power of two from 2 on, for a light of each colour up to these over plain_surfaces(): section 17.
constexpr float kWindowColors[] = {0.23f, 0.54f, 1.15f, 1.9f};

// The three channels as lanes.
HWY_INLINE void make_settled_light(const ListedLight& listed, SettledLight& out) {
  static_assert(offsetof(LightRow, range) == offsetof(LightRow, color) + 3 * sizeof(float) &&
                offsetof(ListedLight, cut2) == offsetof(ListedLight, position) + 3 * sizeof(float));
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto color = hn::LoadU(d, listed.light->color);
  auto window = hn::Set(di, 2);
  for (int k = 0; k < 3; ++k)
    window = hn::IfThenElse(hn::RebindMask(di, hn::Gt(color, hn::Set(d, kWindowColors[k]))), hn::Set(di, 4 << k), window);
  const auto bounded = hn::And(hn::And(hn::Ge(color, hn::Zero(d)), hn::Le(color, hn::Set(d, kWindowColors[3]))),
                               hn::Le(hn::Set(d, listed.cut2), hn::Set(d, 0x1p100f)));
  const auto clear = hn::Sub(hn::Set(di, 1 << kBelowCode), hn::Add(window, window));
  hn::StoreU(hn::LoadU(d, listed.position), d, out.position);
  hn::StoreU(hn::Mul(color, hn::Set(d, 255.0f / 512.0f)), d, out.color);
  out.half_share = 0.5f / listed.light->range;
  hn::StoreU(hn::Add(window, hn::Set(di, (1 << 30) + (1 << (kBelowCode - 1)))), di, out.bias);
  hn::StoreU(hn::IfThenElseZero(hn::RebindMask(di, bounded), clear), di, out.clear);
}

/// Pixels whose normals and albedo are in the ranges of section 17.
HWY_INLINE MF plain_surfaces(const PixelVector& px) {
  const DF d;
  MF plain = hn::Le(dot3(px.n, px.n), hn::Set(d, 1.0f + 0x1p-10f));
  for (int c = 0; c < 3; ++c) {
    plain = hn::And(plain, hn::Ge(px.albedo[c], hn::Zero(d)));
    plain = hn::And(plain, hn::Le(px.albedo[c], hn::Set(d, 1.0f)));
  }
  return plain;
}

/// Codes of a block's pixels, as the upper bits of t add up.
struct SettledCodes {
  hn::Vec<DI> sum[3];
  hn::Vec<DI> lit;  ///< where lights may add to pixels that they do not light: those that light each

  HWY_INLINE void clear() { sum[0] = sum[1] = sum[2] = lit = hn::Zero(DI()); }
  HWY_INLINE hn::Vec<DI> lights(bool all_light) const { return all_light ? hn::ShiftRight<16>(sum[0]) : lit; }
  HWY_INLINE VF codes(int c) const { return hn::ConvertTo(DF(), hn::And(sum[c], hn::Set(DI(), 0xFFFF))); }
};

/// Whether codes of lights of this shape can be settled: Lambert with a linear window.
template <class Shape>
constexpr bool settles_codes() {
  if constexpr (Shape::compiled && kLanes == kBlockPixels)
    return Shape::shape.falloff == Falloff::linear_range && Shape::shape.order == TermOrder::factored &&
           Shape::shape.cone == Cone::none && Shape::shape.diffuse == Diffuse::clamped &&
           Shape::shape.specular == Specular::none && !Shape::shape.renormalize;
  return false;
}

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

/// 1 / sqrt(x) as the CPU estimates it: at most 2^-14 off as a share of it, with whichever bits.
struct EstimatedRoot {
  static HWY_INLINE VF reciprocal(VF x) { return hn::ApproximateReciprocalSqrt(x); }
};

/// Some pairs of a light and a vector of pixels, a step of each after the other.
template <size_t kMany, class Root = EstimatedRoot>
struct SettledPairs {
  const PixelVector* px[kMany];
  const SettledLight* light[kMany];
  MF lit[kMany];  ///< at first, the pixels in question

  /// What the colours are multiplied by, 2 N . L f where all is exact. Leaves `lit` to the pixels that are.
  template <class Shape>
  HWY_INLINE void weigh(const LightTerms<Shape>& terms, VF weight[kMany]) {
    const DF d;
    LightChain at[kMany];
    VF root[kMany];
    for (size_t k = 0; k < kMany; ++k) terms.place(*px[k], false, light[k]->position, at[k]);
    for (size_t k = 0; k < kMany; ++k) {
      lit[k] = less_within(less_within(lit[k], at[k].d2, hn::Set(d, light[k]->cut2)), hn::Zero(d), at[k].nl);
      root[k] = Root::reciprocal(at[k].d2);
    }
    for (size_t k = 0; k < kMany; ++k)  // 2 / sqrt
      root[k] = hn::Mul(root[k], hn::Sub(hn::Set(d, 3.0f), hn::Mul(at[k].d2, hn::Mul(root[k], root[k]))));
    for (size_t k = 0; k < kMany; ++k) {
      const VF share = hn::Mul(hn::Mul(at[k].d2, hn::Set(d, light[k]->half_share)), root[k]);
      weight[k] = hn::Mul(hn::Mul(at[k].nl, root[k]), hn::Sub(hn::Set(d, 1.0f), share));
    }
  }

  /// The estimate of 255 / 256 of a channel's term.
  HWY_INLINE VF estimate(size_t k, int c, VF weight) const {
    return hn::Mul(hn::Mul(px[k]->albedo[c], hn::Set(DF(), light[k]->color[c])), weight);
  }

  /// Adds the codes that are settled; returns the pixels of each pair that are lit and whose are not.
  template <class Shape>
  HWY_INLINE void settle(const LightTerms<Shape>& terms, SettledCodes* const out[kMany], MF open[kMany]) {
    const DF d;
    const DI di;
    VF weight[kMany];
    hn::Vec<DI> t[kMany][3];
    MF settled[kMany];
    weigh(terms, weight);
    for (size_t k = 0; k < kMany; ++k) {
      settled[k] = lit[k];
      for (int c = 0; c < 3; ++c) {
        const VF x = estimate(k, c, weight[k]);
        t[k][c] = hn::BitCast(di, hn::Add(x, hn::BitCast(d, hn::Set(di, light[k]->bias[c]))));
        settled[k] = has_any(settled[k], t[k][c], hn::Set(di, light[k]->clear[c]));
      }
    }
    for (size_t k = 0; k < kMany; ++k) {
      for (int c = 0; c < 3; ++c)
        out[k]->sum[c] = hn::Add(out[k]->sum[c], hn::IfThenElseZero(hn::RebindMask(di, settled[k]),
                                                                  hn::ShiftRight<kBelowCode>(t[k][c])));
      open[k] = hn::AndNot(settled[k], lit[k]);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
