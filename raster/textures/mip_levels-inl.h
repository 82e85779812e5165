// Levels of detail of vectors of lookups, and the levels of a texture that they read. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_MIP_LEVELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_MIP_LEVELS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_MIP_LEVELS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_MIP_LEVELS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "core/simd/lanes-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Texture coordinates of pixels, floats held in f64, and their derivatives from pixel to pixel.
struct UvPoint {
  V64 uv[2], x[2], y[2];
};

/// log2 as docs/arithmetic.md section 9 has it, of what lies in [2^-1000, 2^1000], in place. Vectors go together, for
/// each waits for its sum, term after term.
template <int kVectors>
HWY_INLINE void take_log2(V64 value[kVectors]) {
  const D64 d;
  const hn::RebindToUnsigned<D64> du;
  const V64 one = hn::Set(d, 1.0);
  V64 exponent[kVectors], s[kVectors], z[kVectors], sum[kVectors];
#pragma GCC unroll 4
  for (int h = 0; h < kVectors; ++h) {
    const auto bits = hn::BitCast(du, value[h]);
    // An integer below 2^52 in the last bits of 2^52 is a double without conversion.
    const auto shifted = hn::Or(hn::ShiftRight<52>(bits), hn::Set(du, 0x4330000000000000ull));
    exponent[h] = hn::Sub(hn::BitCast(d, shifted), hn::Set(d, 0x1p52 + 1022.0));
    V64 m =
        hn::BitCast(d, hn::Or(hn::And(bits, hn::Set(du, 0x000FFFFFFFFFFFFFull)), hn::Set(du, 0x3FE0000000000000ull)));
    const auto low = hn::Lt(m, hn::Set(d, 0.70710678118654752440));
    m = hn::IfThenElse(low, hn::Mul(m, hn::Set(d, 2.0)), m);
    exponent[h] = hn::IfThenElse(low, hn::Sub(exponent[h], one), exponent[h]);
    s[h] = hn::Div(hn::Sub(m, one), hn::Add(m, one)), z[h] = hn::Mul(s[h], s[h]);
    sum[h] = hn::Set(d, 1.0 / 21.0);
  }
#pragma GCC unroll 10
  for (int k = 19; k >= 1; k -= 2)
#pragma GCC unroll 4
    for (int h = 0; h < kVectors; ++h) sum[h] = hn::Add(hn::Mul(sum[h], z[h]), hn::Set(d, 1.0 / double(k)));
#pragma GCC unroll 4
  for (int h = 0; h < kVectors; ++h)
    value[h] = hn::Add(hn::Mul(hn::Mul(s[h], hn::Set(d, 2.8853900817779268147)), sum[h]), exponent[h]);
}

/// Levels of detail: log2 of the longer of the pixel's two sides in texels of level 0, biased, clamped.
template <int kVectors>
HWY_INLINE void levels_of_detail(const TextureView& texture, const UvPoint* at, V64 lod[kVectors]) {
  const D64 d;
  const V64 width = hn::Set(d, double(texture.level[0].width)), height = hn::Set(d, double(texture.level[0].height));
  const auto length2 = [&](const V64 side[2]) {
    const V64 a = hn::Mul(side[0], width), b = hn::Mul(side[1], height);
    return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
  };
  for (int h = 0; h < kVectors; ++h) {
    const V64 x2 = length2(at[h].x), y2 = length2(at[h].y);
    V64 rho2 = hn::IfThenElse(hn::Gt(y2, x2), y2, x2);
    rho2 = hn::IfThenElse(hn::Gt(rho2, hn::Set(d, 0x1p-1000)), rho2, hn::Set(d, 0x1p-1000));
    lod[h] = hn::IfThenElse(hn::Lt(rho2, hn::Set(d, 0x1p1000)), rho2, hn::Set(d, 0x1p1000));
  }
  constexpr int kTogether = kVectors < 4 ? kVectors : 4;
  static_assert(kVectors % kTogether == 0);
  for (int h = 0; h < kVectors; h += kTogether) take_log2<kTogether>(lod + h);
  const Sampler& s = texture.sampler;
  const V64 bias = hn::Set(d, double(s.lod_bias)), low = hn::Set(d, double(s.lod_min)),
            high = hn::Set(d, double(s.lod_max));
  for (int h = 0; h < kVectors; ++h) {
    const V64 biased = hn::Add(hn::Mul(hn::Set(d, 0.5), lod[h]), bias);
    lod[h] = clamped(biased, low, high);
  }
}

/// The level a lookup reads first, an integer, the share of the next one, and whether texels are mixed.
struct MipChoice {
  V64 level, part;
  M64 linear;

  HWY_INLINE void set_level(const TextureView& texture, V64 lod) {
    const D64 d;
    const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0), half = hn::Set(d, 0.5);
    const V64 last = hn::Set(d, double(texture.levels - 1)), positive = hn::IfThenElseZero(hn::Gt(lod, zero), lod);
    level = part = zero;
    if (texture.sampler.mip_filter == MipFilter::nearest) {
      const V64 below = hn::Floor(positive);
      const V64 chosen = hn::Add(below, hn::IfThenElseZero(hn::Gt(hn::Sub(positive, below), half), one));
      level = hn::IfThenElse(hn::Gt(chosen, last), last, chosen);
    } else if (texture.sampler.mip_filter == MipFilter::linear) {
      const V64 within = hn::IfThenElse(hn::Gt(positive, last), last, positive);
      level = hn::Floor(within);
      part = hn::Sub(within, level);
    }
  }

  HWY_INLINE void set_filter(const Sampler& sampler, V64 lod) {
    const bool mag_linear = sampler.mag_filter == Filter::linear, min_linear = sampler.min_filter == Filter::linear;
    const V64 zero = hn::Zero(D64());
    const auto minified = hn::Gt(lod, zero);
    if (mag_linear == min_linear)
      linear = mag_linear ? hn::Eq(zero, zero) : hn::Gt(zero, zero);
    else
      linear = min_linear ? minified : hn::Not(minified);
  }
};

template <int kVectors>
HWY_INLINE void choose_mips(const TextureView& texture, const UvPoint* at, MipChoice* mip) {
  const Sampler& s = texture.sampler;
  V64 lod[kVectors];
  if (s.mip_filter != MipFilter::none || s.mag_filter != s.min_filter)
    levels_of_detail<kVectors>(texture, at, lod);
  else
    std::fill_n(lod, kVectors, hn::Zero(D64()));
  for (int h = 0; h < kVectors; ++h) mip[h].set_level(texture, lod[h]), mip[h].set_filter(s, lod[h]);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
