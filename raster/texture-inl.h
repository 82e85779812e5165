// Texture lookups for vectors of pixels; texels are fetched lane by lane. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURE_INL_H_
#undef TRUESHADE_RASTER_TEXTURE_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>

#include "core/half.h"
#include "core/srgb.h"
#include "raster/texture.h"
#include "raster/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Mask64 = hn::Mask<D64>;
inline constexpr size_t kMostLanes = HWY_MAX_BYTES / sizeof(double);

/// The same lanes of as many floats.
HWY_INLINE hn::Mask<D32> float_mask(Mask64 mask) {
  return hn::Gt(hn::DemoteTo(D32(), hn::IfThenElseZero(mask, hn::Set(D64(), 1.0))), hn::Zero(D32()));
}

/// Texture coordinates of pixels, floats held in f64, and their derivatives from pixel to pixel.
struct UvPoint {
  V64 uv[2], x[2], y[2];
};

/// log2 as docs/arithmetic.md section 9 has it, of what lies in [2^-1000, 2^1000].
HWY_INLINE V64 log2_of(V64 value) {
  const D64 d;
  const hn::RebindToUnsigned<D64> du;
  const auto bits = hn::BitCast(du, value);
  // An integer below 2^52 in the last bits of 2^52 is a double without conversion.
  const auto shifted = hn::Or(hn::ShiftRight<52>(bits), hn::Set(du, 0x4330000000000000ull));
  V64 exponent = hn::Sub(hn::BitCast(d, shifted), hn::Set(d, 0x1p52 + 1022.0));
  V64 m = hn::BitCast(d, hn::Or(hn::And(bits, hn::Set(du, 0x000FFFFFFFFFFFFFull)), hn::Set(du, 0x3FE0000000000000ull)));
  const auto low = hn::Lt(m, hn::Set(d, 0.70710678118654752440));
  m = hn::IfThenElse(low, hn::Mul(m, hn::Set(d, 2.0)), m);
  exponent = hn::IfThenElse(low, hn::Sub(exponent, hn::Set(d, 1.0)), exponent);
  const V64 one = hn::Set(d, 1.0), s = hn::Div(hn::Sub(m, one), hn::Add(m, one)), z = hn::Mul(s, s);
  V64 sum = hn::Set(d, 1.0 / 21.0);
  for (int k = 19; k >= 1; k -= 2) sum = hn::Add(hn::Mul(sum, z), hn::Set(d, 1.0 / double(k)));
  return hn::Add(hn::Mul(hn::Mul(s, hn::Set(d, 2.8853900817779268147)), sum), exponent);
}

/// Level of detail: log2 of the longer of the pixel's two sides in texels of level 0, biased, clamped.
HWY_INLINE V64 level_of_detail(const TextureView& texture, const UvPoint& at) {
  const D64 d;
  const V64 width = hn::Set(d, double(texture.level[0].width)), height = hn::Set(d, double(texture.level[0].height));
  const auto length2 = [&](const V64 side[2]) {
    const V64 a = hn::Mul(side[0], width), b = hn::Mul(side[1], height);
    return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
  };
  const V64 x2 = length2(at.x), y2 = length2(at.y);
  V64 rho2 = hn::IfThenElse(hn::Gt(y2, x2), y2, x2);
  rho2 = hn::IfThenElse(hn::Gt(rho2, hn::Set(d, 0x1p-1000)), rho2, hn::Set(d, 0x1p-1000));
  rho2 = hn::IfThenElse(hn::Lt(rho2, hn::Set(d, 0x1p1000)), rho2, hn::Set(d, 0x1p1000));
  const Sampler& s = texture.sampler;
  V64 lod = hn::Add(hn::Mul(hn::Set(d, 0.5), log2_of(rho2)), hn::Set(d, double(s.lod_bias)));
  const V64 low = hn::Set(d, double(s.lod_min)), high = hn::Set(d, double(s.lod_max));
  lod = hn::IfThenElse(hn::Lt(lod, low), low, lod);
  return hn::IfThenElse(hn::Gt(lod, high), high, lod);
}

/// Texel of an index before wrapping, for a side of n texels; -1 and n are the border (GL 4.6 core, table 8.20).
HWY_INLINE V64 wrapped(Wrap wrap, V64 i, V64 n) {
  const D64 d;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto clamped = [&](V64 v, V64 low, V64 high) {
    const V64 above = hn::IfThenElse(hn::Lt(v, low), low, v);
    return hn::IfThenElse(hn::Gt(above, high), high, above);
  };
  const auto modulo = [&](V64 v, V64 period) { return hn::Sub(v, hn::Mul(period, hn::Floor(hn::Div(v, period)))); };
  switch (wrap) {
    case Wrap::repeat:
      return modulo(i, n);
    case Wrap::mirrored_repeat: {
      const V64 twice = hn::Add(n, n), place = modulo(i, twice);
      return hn::IfThenElse(hn::Lt(place, n), place, hn::Sub(hn::Sub(twice, one), place));
    }
    case Wrap::clamp_to_edge:
      return clamped(i, zero, hn::Sub(n, one));
    case Wrap::clamp_to_border:
      return clamped(i, hn::Sub(zero, one), n);
    case Wrap::mirror_clamp_to_edge:
      return clamped(hn::IfThenElse(hn::Lt(i, zero), hn::Sub(hn::Sub(zero, one), i), i), zero, hn::Sub(n, one));
  }
  return i;
}

/// A coordinate's two texels along one axis and the weight of the second, 0 where the filter is nearest.
struct AxisTexels {
  V64 first, second, weight;
};

HWY_INLINE AxisTexels axis_texels(Wrap wrap, V64 coordinate, V64 n, Mask64 linear) {
  const D64 d;
  // From 2^24 on a float is an even integer: for the repeating modes as good as 0, for the others far outside.
  const V64 most = hn::Set(d, 0x1p24);
  const bool repeats = wrap == Wrap::repeat || wrap == Wrap::mirrored_repeat;
  const auto beyond = hn::Ge(hn::Abs(coordinate), most);
  const V64 held = repeats ? hn::Zero(d) : hn::CopySign(most, coordinate);
  const V64 texels = hn::Mul(hn::IfThenElse(beyond, held, coordinate), n);
  const V64 place = hn::Sub(texels, hn::IfThenElseZero(linear, hn::Set(d, 0.5)));
  const V64 below = hn::Floor(place);
  const V64 next = hn::Add(below, hn::IfThenElseZero(linear, hn::Set(d, 1.0)));
  return {wrapped(wrap, below, n), wrapped(wrap, next, n), hn::IfThenElseZero(linear, hn::Sub(place, below))};
}

/// One texel's RGBA, of a format of floats.
HWY_INLINE void fetch(TextureFormat format, const TextureView::Level& level, int x, int y, const float border[4],
                      size_t lane, float out[4][kMostLanes]) {
  if (x < 0 || y < 0 || x >= level.width || y >= level.height) {
    for (size_t c = 0; c < 4; ++c) out[c][lane] = border[c];
    return;
  }
  const uint8_t* at = level.bytes + (size_t(y) * size_t(level.width) + size_t(x)) * size_t(bytes_per_texel(format));
  for (size_t c = 0; c < 4; ++c) {
    if (format == TextureFormat::rgba16f)
      out[c][lane] = float_from_half(uint16_t(at[2 * c] | at[2 * c + 1] << 8));
    else
      std::memcpy(&out[c][lane], at + 4 * c, sizeof(float));
  }
}

/// Texels of four bytes, a lane each: the word at place[lane] of bytes[lane].
HWY_INLINE void fetch_words(TextureFormat format, const uint8_t* const* bytes, V64 place, V32 out[4]) {
  const D32 df;
  const I32 di;
  alignas(64) int32_t at[kMostLanes];
  alignas(64) int32_t word[kMostLanes];
  hn::Store(hn::DemoteTo(di, place), di, at);
  for (size_t lane = 0; lane < hn::Lanes(df); ++lane) {
    const uint8_t* const texel = bytes[lane] + 4 * size_t(at[lane]);
    word[lane] = int32_t(texel[0] | uint32_t(texel[1]) << 8 | uint32_t(texel[2]) << 16 | uint32_t(texel[3]) << 24);
  }
  const auto words = hn::Load(di, word), byte = hn::Set(di, 255);
  const hn::Vec<I32> code[4] = {hn::And(words, byte), hn::And(hn::ShiftRight<8>(words), byte),
                                hn::And(hn::ShiftRight<16>(words), byte), hn::And(hn::ShiftRight<24>(words), byte)};
  for (int c = 0; c < 4; ++c)
    out[c] = format == TextureFormat::srgb8_a8 && c < 3 ? hn::GatherIndex(df, kLinearOfSrgb8.data(), code[c])
                                                        : hn::Div(hn::ConvertTo(df, code[c]), hn::Set(df, 255.0f));
}

/// a + (b - a) weight, as (1 - w) a + w b: relative precision where a, b >= 0, and a, b themselves at both ends.
HWY_INLINE V64 mix(V64 a, V64 b, V64 weight) {
  return hn::Add(hn::Mul(hn::Sub(hn::Set(D64(), 1.0), weight), a), hn::Mul(weight, b));
}

/// The filtered texel of one level a lane, in f64. `levels`: the level as a double, an integer.
HWY_INLINE void sample_level(const TextureView& texture, V64 levels, const V64 uv[2], Mask64 linear, Mask64 valid,
                             V64 rgba[4]) {
  const D64 d;
  const D32 df;
  const size_t lanes = hn::Lanes(d);
  alignas(64) double level[kMostLanes], width[kMostLanes], height[kMostLanes], used[kMostLanes];
  const uint8_t* bytes[kMostLanes];
  hn::Store(levels, d, level);
  hn::Store(hn::IfThenElseZero(valid, hn::Set(d, 1.0)), d, used);
  for (size_t i = 0; i < lanes; ++i) {
    const TextureView::Level& l = texture.level[used[i] != 0.0 ? int(level[i]) : 0];
    width[i] = l.width;
    height[i] = l.height;
    bytes[i] = l.bytes;
  }
  const Sampler& s = texture.sampler;
  const AxisTexels u = axis_texels(s.wrap[0], uv[0], hn::Load(d, width), linear),
                   v = axis_texels(s.wrap[1], uv[1], hn::Load(d, height), linear);
  alignas(64) double x[2][kMostLanes], y[2][kMostLanes];
  hn::Store(u.first, d, x[0]);
  hn::Store(u.second, d, x[1]);
  hn::Store(v.first, d, y[0]);
  hn::Store(v.second, d, y[1]);
  const float border[4] = {s.border.r, s.border.g, s.border.b, s.border.a};
  const bool nearest = s.mag_filter == Filter::nearest && s.min_filter == Filter::nearest;
  const bool of_words = bytes_per_texel(texture.format) == 4;
  V64 row[2][4];
  for (int j = 0; j < (nearest ? 1 : 2); ++j) {
    V64 side[2][4];
    for (int i = 0; i < (nearest ? 1 : 2); ++i) {
      if (of_words) {
        const V64 column = i == 0 ? u.first : u.second, line = j == 0 ? v.first : v.second, zero = hn::Zero(d);
        const V64 wide = hn::Load(d, width), high = hn::Load(d, height);
        const auto inside = hn::And(hn::And(hn::Ge(column, zero), hn::Lt(column, wide)),
                                    hn::And(hn::Ge(line, zero), hn::Lt(line, high)));
        V32 color[4];
        fetch_words(texture.format, bytes, hn::IfThenElseZero(inside, hn::Add(hn::Mul(line, wide), column)), color);
        for (size_t c = 0; c < 4; ++c)
          side[i][c] = hn::IfThenElse(inside, hn::PromoteTo(d, color[c]), hn::Set(d, double(border[c])));
        continue;
      }
      alignas(64) float texel[4][kMostLanes] = {};
      for (size_t lane = 0; lane < lanes; ++lane)
        if (used[lane] != 0.0)
          fetch(texture.format, texture.level[int(level[lane])], int(x[i][lane]), int(y[j][lane]), border, lane, texel);
      for (size_t c = 0; c < 4; ++c) side[i][c] = hn::PromoteTo(d, hn::Load(df, texel[c]));
    }
    for (size_t c = 0; c < 4; ++c) row[j][c] = nearest ? side[0][c] : mix(side[0][c], side[1][c], u.weight);
  }
  for (size_t c = 0; c < 4; ++c) rgba[c] = nearest ? row[0][c] : mix(row[0][c], row[1][c], v.weight);
}

/// RGBA of the lanes in `valid`; the others mean nothing.
inline void sample(const TextureView& texture, const UvPoint& at, Mask64 valid, V32 rgba[4]) {
  const D64 d;
  const D32 df;
  const Sampler& s = texture.sampler;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0), half = hn::Set(d, 0.5);
  const V64 last = hn::Set(d, double(texture.levels - 1));
  V64 level = zero, part = zero;
  auto minified = hn::Gt(zero, zero);
  if (s.mip_filter != MipFilter::none || s.mag_filter != s.min_filter) {
    const V64 lod = level_of_detail(texture, at);
    minified = hn::Gt(lod, zero);
    if (s.mip_filter == MipFilter::nearest) {
      const V64 positive = hn::IfThenElseZero(minified, lod), below = hn::Floor(positive);
      const V64 chosen = hn::Add(below, hn::IfThenElseZero(hn::Gt(hn::Sub(positive, below), half), one));
      level = hn::IfThenElse(hn::Gt(chosen, last), last, chosen);
    } else if (s.mip_filter == MipFilter::linear) {
      const V64 positive = hn::IfThenElseZero(minified, lod);
      const V64 held = hn::IfThenElse(hn::Gt(positive, last), last, positive);
      level = hn::Floor(held);
      part = hn::Sub(held, level);
    }
  }
  const bool mag_linear = s.mag_filter == Filter::linear, min_linear = s.min_filter == Filter::linear;
  const auto all = hn::Eq(zero, zero), none = hn::Gt(zero, zero);
  const Mask64 linear = mag_linear == min_linear ? (mag_linear ? all : none)
                        : min_linear             ? minified
                                                 : hn::Not(minified);
  V64 value[4];
  sample_level(texture, level, at.uv, linear, valid, value);
  const bool blends = s.mip_filter == MipFilter::linear && !hn::AllFalse(d, hn::And(valid, hn::Gt(part, zero)));
  if (blends) {
    V64 next[4];
    const V64 second = hn::Add(level, one);
    sample_level(texture, hn::IfThenElse(hn::Gt(second, last), last, second), at.uv, linear, valid, next);
    for (size_t c = 0; c < 4; ++c) value[c] = mix(value[c], next[c], part);
  }
  // + 0: what a weight of 0 adds above, so that no lane sees what its neighbours need.
  for (size_t c = 0; c < 4; ++c) rgba[c] = hn::DemoteTo(df, hn::Add(value[c], zero));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
