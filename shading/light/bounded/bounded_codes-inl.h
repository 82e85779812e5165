// Codes of one light's term in fixed point, from estimates of 1 / sqrt with a bound of the error: a code that no value
// within the bound changes is the term's own (Ziv, Fast evaluation of elementary mathematical functions with correctly
// rounded last bit, 1991); the other pixels of a pair are left to the term itself. The proof is docs/arithmetic.md
// section 17; it asks 2^-14 of the estimate, whose bits differ between CPUs. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_LIGHT_BOUNDED_BOUNDED_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_LIGHT_BOUNDED_BOUNDED_CODES_INL_H_
#undef TRUESHADE_SHADING_LIGHT_BOUNDED_BOUNDED_CODES_INL_H_
#else
#define TRUESHADE_SHADING_LIGHT_BOUNDED_BOUNDED_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/regions-inl.h"
#include "shading/light/lists/tile_lights.h"

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

  void set(const ListedLight& listed);
};

/// The same in all lanes.
struct SettledLanes {
  VF position[3], cut2, color[3], half_share;
  hn::Vec<DI> bias[3], clear[3];

  HWY_INLINE explicit SettledLanes(const SettledLight& light) {
    for (int c = 0; c < 3; ++c) {
      position[c] = hn::Set(DF(), light.position[c]), color[c] = hn::Set(DF(), light.color[c]);
      bias[c] = hn::Set(DI(), light.bias[c]), clear[c] = hn::Set(DI(), light.clear[c]);
    }
    cut2 = hn::Set(DF(), light.cut2), half_share = hn::Set(DF(), light.half_share);
  }
};

/// The least e, a power of two from 2 on, for a light of each colour up to these over plain_surfaces(): section 17.
constexpr float kWindowColors[] = {0.23f, 0.54f, 1.15f, 1.9f};

// The three channels as lanes.
HWY_INLINE void SettledLight::set(const ListedLight& listed) {
  static_assert(offsetof(LightRow, range) == offsetof(LightRow, color) + 3 * sizeof(float) &&
                offsetof(ListedLight, cut2) == offsetof(ListedLight, position) + 3 * sizeof(float));
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto color = hn::LoadU(d, listed.light->color);
  auto window = hn::Set(di, 2);
  for (int k = 0; k < 3; ++k)
    window =
        hn::IfThenElse(hn::RebindMask(di, hn::Gt(color, hn::Set(d, kWindowColors[k]))), hn::Set(di, 4 << k), window);
  const auto bounded = hn::And(hn::And(hn::Ge(color, hn::Zero(d)), hn::Le(color, hn::Set(d, kWindowColors[3]))),
                               hn::Le(hn::Set(d, listed.cut2), hn::Set(d, 0x1p100f)));
  const auto clear = hn::Sub(hn::Set(di, 1 << kBelowCode), hn::Add(window, window));
  hn::StoreU(hn::LoadU(d, listed.position), d, position);
  hn::StoreU(hn::Mul(color, hn::Set(d, 255.0f / 512.0f)), d, this->color);
  half_share = 0.5f / listed.light->range;
  hn::StoreU(hn::Add(window, hn::Set(di, (1 << 30) + (1 << (kBelowCode - 1)))), di, bias);
  hn::StoreU(hn::IfThenElseZero(hn::RebindMask(di, bounded), clear), di, this->clear);
}

/// Pixels whose normals and albedo are in the ranges of section 17. Their bits tell: those of negative numbers and of
/// what is no number are greater than those of 1.
HWY_INLINE MF plain_surfaces(const PixelVector& px) {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  auto most = hn::BitCast(du, px.albedo[0]);
  for (int c = 1; c < 3; ++c) most = hn::Max(most, hn::BitCast(du, px.albedo[c]));
  const auto beyond = hn::Gt(most, hn::BitCast(du, hn::Set(d, 1.0f)));
  return hn::AndNot(hn::RebindMask(d, beyond), hn::Le(dot3(px.n, px.n), hn::Set(d, 1.0f + 0x1p-10f)));
}

/// The code of fixed point, up to `largest`, that a light adds to a channel.
HWY_INLINE VF added_code(VF x, MF adds, VF largest) {
  const DF d;
  const MF counts = hn::And(adds, hn::Gt(x, hn::Zero(d)));  // and is a number
  return hn::IfThenElseZero(counts, hn::Round(hn::Mul(hn::Min(x, hn::Set(d, 1.0f)), largest)));
}

/// Codes of a block's pixels, as the upper bits of t add up.
struct SettledCodes {
  hn::Vec<DI> sum[3];
  hn::Vec<DI> lit;  ///< lights that light each pixel

  HWY_INLINE void clear() { sum[0] = sum[1] = sum[2] = lit = hn::Zero(DI()); }
  HWY_INLINE VF codes(int c) const { return hn::ConvertTo(DF(), sum[c]); }  ///< when settled

  /// What is settled of a light.
  HWY_INLINE void add(MF settled, const hn::Vec<DI> t[3]) {
    const auto counts = hn::RebindMask(DI(), settled);
    for (int c = 0; c < 3; ++c) sum[c] = hn::Add(sum[c], hn::IfThenElseZero(counts, hn::ShiftRight<kBelowCode>(t[c])));
  }
  /// A light's term itself, of some pixels.
  template <class Terms>
  HWY_INLINE void add(const Terms& terms, const PixelVector& px, const LightTerm& term, MF pixels) {
    const DF d;
    const DI di;
    const MF adds = hn::And(term.adds, pixels);
    for (int c = 0; c < 3; ++c) {
      const VF code = added_code(terms.tinted(px, term.color[c], c), adds, hn::Set(d, 255.0f));
      sum[c] = hn::Add(sum[c], hn::ConvertTo(di, code));
    }
    const auto lights = hn::RebindMask(di, hn::And(term.lit, pixels));
    lit = hn::Add(lit, hn::IfThenElseZero(lights, hn::Set(di, 1)));
  }
  /// After at most kCodesAtOnce lights. `all_light`: pixels that t were added to are lit, and not counted in `lit`.
  HWY_INLINE void settle(bool all_light) {
    const DI di;
    if (all_light) lit = hn::Add(lit, hn::ShiftRight<16>(sum[0]));
    for (int c = 0; c < 3; ++c) sum[c] = hn::Min(hn::And(sum[c], hn::Set(di, 0xFFFF)), hn::Set(di, 255));
  }
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

/// Some pairs of one light and a vector of pixels, a step of each after the other.
template <size_t kMany, class Root = EstimatedRoot>
struct SettledPairs {
  using Light = SettledLight;
  using Lanes = SettledLanes;
  static constexpr size_t kCount = kMany;
  static constexpr bool kSpecular = false;
  const PixelVector* px[kMany];
  MF open[kMany];  ///< at first the pixels in question, then those that are lit and not settled

  /// What the colours are multiplied by, 2 N . L f where all is exact.
  struct Weights {
    VF weight[kMany];
  };

  /// Leaves `open` to the pixels that are lit.
  HWY_INLINE void weigh(const Lanes& light, Weights& of) {
    const DF d;
    VF d2[kMany], nl[kMany], root[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      VF to_light[3];
      for (int c = 0; c < 3; ++c) to_light[c] = hn::Sub(light.position[c], px[k]->p[c]);
      nl[k] = dot3(px[k]->n, to_light), d2[k] = dot3(to_light, to_light);
    }
    for (size_t k = 0; k < kMany; ++k) {
      open[k] = less_within(less_within(open[k], d2[k], light.cut2), hn::Zero(d), nl[k]);
      root[k] = Root::reciprocal(d2[k]);
    }
    for (size_t k = 0; k < kMany; ++k)  // 2 / sqrt
      root[k] = hn::Mul(root[k], hn::Sub(hn::Set(d, 3.0f), hn::Mul(d2[k], hn::Mul(root[k], root[k]))));
    for (size_t k = 0; k < kMany; ++k) {
      const VF share = hn::Mul(hn::Mul(d2[k], light.half_share), root[k]);
      of.weight[k] = hn::Mul(hn::Mul(nl[k], root[k]), hn::Sub(hn::Set(d, 1.0f), share));
    }
  }

  /// The estimate of 255 / 256 of a channel's term.
  HWY_INLINE VF estimate(const Lanes& light, size_t k, int c, VF weight) const {
    return hn::Mul(hn::Mul(px[k]->albedo[c], light.color[c]), weight);
  }

  /// Adds the codes that are settled.
  HWY_INLINE void settle(const Lanes& light, const Weights& of, SettledCodes* const out[kMany]) {
    const DF d;
    const DI di;
    hn::Vec<DI> t[kMany][3];
    MF settled[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      settled[k] = open[k];
      for (int c = 0; c < 3; ++c) {
        t[k][c] = hn::BitCast(di, hn::Add(estimate(light, k, c, of.weight[k]), hn::BitCast(d, light.bias[c])));
        settled[k] = has_any(settled[k], t[k][c], light.clear[c]);
      }
    }
    for (size_t k = 0; k < kMany; ++k) {
      out[k]->add(settled[k], t[k]);
      open[k] = hn::AndNot(settled[k], open[k]);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
