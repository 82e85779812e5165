// Codes of one light's term in fixed point, from estimates of 1 / sqrt with a bound of the error: a code that no value
// within the bound changes is the term's own (Ziv, Fast evaluation of elementary mathematical functions with correctly
// rounded last bit, 1991); the other pixels of a pair are left to the term itself. The proof is docs/proofs.md
// section 17; it asks 2^-14 of the estimate, whose bits differ between CPUs. Included once per SIMD target.
#if defined(TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_CODES_INL_H_
#undef TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_CODES_INL_H_
#else
#define TRUESHADE_SHADING_BLEND_BOUNDED_BOUNDED_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "shading/blend/added_light-inl.h"
#include "shading/light/bounded/estimates-inl.h"
#include "shading/light/fast/compiled_models.h"
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
struct alignas(64) BoundedLight {
  float position[3], cut2;
  float color[3];    ///< times 255 / 512
  float half_share;  ///< 0.5 / range
  int32_t bias[4];   ///< 2 + 1 / 512 + e / 2^22, a float
  int32_t clear[4];  ///< bits of t, one of which is set where no border is near; 0: nothing is proved

  void set(const ListedLight& listed);
};

/// The same in all lanes.
struct BoundedLightLanes {
  VF position[3], cut2, color[3], half_share;
  hn::Vec<DI> bias[3], clear[3];

  HWY_INLINE explicit BoundedLightLanes(const BoundedLight& light) {
    for (int c = 0; c < 3; ++c) {
      position[c] = hn::Set(DF(), light.position[c]), color[c] = hn::Set(DF(), light.color[c]);
      bias[c] = hn::Set(DI(), light.bias[c]), clear[c] = hn::Set(DI(), light.clear[c]);
    }
    cut2 = hn::Set(DF(), light.cut2), half_share = hn::Set(DF(), light.half_share);
  }
};

/// The least e, a power of two from 2 on, for a light of each colour up to these over surfaces_in_proof_range():
/// section 17.
constexpr float kWindowColors[] = {0.23f, 0.54f, 1.15f, 1.9f};

// The three channels as lanes.
HWY_INLINE void BoundedLight::set(const ListedLight& listed) {
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
HWY_INLINE MF surfaces_in_proof_range(const PixelVector& px) {
  const DF d;
  const hn::RebindToUnsigned<DF> du;
  auto most = hn::BitCast(du, px.albedo[0]);
  for (int c = 1; c < 3; ++c) most = hn::Max(most, hn::BitCast(du, px.albedo[c]));
  const auto beyond = hn::Gt(most, hn::BitCast(du, hn::Set(d, 1.0f)));
  return hn::AndNot(hn::RebindMask(d, beyond), hn::Le(dot3(px.n, px.n), hn::Set(d, 1.0f + 0x1p-10f)));
}

/// Whose lights light the pixels that t was added to.
enum class CountedLights : uint8_t {
  all,         ///< each of them: the count is in t's upper bits
  separately,  ///< BoundedCodes::lit has the count
};

/// Codes of a block's pixels, as the upper bits of t add up.
struct BoundedCodes {
  hn::Vec<DI> sum[3];
  hn::Vec<DI> lit;  ///< lights that light each pixel

  HWY_INLINE void clear() { sum[0] = sum[1] = sum[2] = lit = hn::Zero(DI()); }
  HWY_INLINE VF codes(int c) const { return hn::ConvertTo(DF(), sum[c]); }  ///< after saturate()

  /// A light's codes where bounds prove them.
  HWY_INLINE void add(MF proved, const hn::Vec<DI> t[3]) {
    const auto counts = hn::RebindMask(DI(), proved);
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
  /// Holds the sums to the largest code; after at most kCodesAtOnce lights.
  HWY_INLINE void saturate(CountedLights counted) {
    const DI di;
    if (counted == CountedLights::all) lit = hn::Add(lit, hn::ShiftRight<16>(sum[0]));
    for (int c = 0; c < 3; ++c) sum[c] = hn::Min(hn::And(sum[c], hn::Set(di, 0xFFFF)), hn::Set(di, 255));
  }
};

/// The shape whose codes section 17 bounds: Lambert with a linear window.
struct WindowLambert {
  static constexpr LightShape shape = kWindowLambert;
  static constexpr bool compiled = true;
};

/// Some pairs of one light and a vector of pixels, a step of each after the other.
template <size_t kMany, class Root = EstimatedRoot>
struct LambertPairs {
  using Light = BoundedLight;
  using Lanes = BoundedLightLanes;
  static constexpr size_t kCount = kMany;
  static constexpr bool kSpecular = false;
  static constexpr CountedLights kCounted = CountedLights::all;
  const PixelVector* px[kMany];
  MF undecided[kMany];  ///< at first the pixels in question, then those that are lit and whose codes are not proved

  /// What the colours are multiplied by, 2 N . L f where all is exact.
  struct Weights {
    VF weight[kMany];
  };

  /// Leaves `undecided` to the pixels that are lit.
  HWY_INLINE void weigh(const Lanes& light, Weights& of) {
    const DF d;
    VF d2[kMany], nl[kMany], root[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      VF to_light[3];
      for (int c = 0; c < 3; ++c) to_light[c] = hn::Sub(light.position[c], px[k]->p[c]);
      nl[k] = dot3(px[k]->n, to_light), d2[k] = dot3(to_light, to_light);
    }
    for (size_t k = 0; k < kMany; ++k) {
      undecided[k] = less_within(less_within(undecided[k], d2[k], light.cut2), hn::Zero(d), nl[k]);
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

  /// Adds the codes that bounds prove.
  HWY_INLINE void decide(const Lanes& light, const Weights& of, BoundedCodes* const out[kMany]) {
    const DF d;
    const DI di;
    hn::Vec<DI> t[kMany][3];
    MF proved[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      proved[k] = undecided[k];
      for (int c = 0; c < 3; ++c) {
        t[k][c] = hn::BitCast(di, hn::Add(estimate(light, k, c, of.weight[k]), hn::BitCast(d, light.bias[c])));
        proved[k] = has_any(proved[k], t[k][c], light.clear[c]);
      }
    }
    for (size_t k = 0; k < kMany; ++k) {
      out[k]->add(proved[k], t[k]);
      undecided[k] = hn::AndNot(proved[k], undecided[k]);
    }
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
