// Texture lookups for vectors of pixels. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_TEXTURE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>

#include "core/half.h"
#include "core/srgb.h"
#include "raster/textures/texel_positions-inl.h"
#include "raster/textures/fast/texel_quads-inl.h"
#include "raster/textures/texture.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The same lanes of as many floats.
HWY_INLINE hn::Mask<D32> float_mask(Mask64 mask) {
  return hn::Gt(hn::DemoteTo(D32(), hn::IfThenElseZero(mask, hn::Set(D64(), 1.0))), hn::Zero(D32()));
}

/// One texel's RGBA.
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
    else if (format == TextureFormat::rgba32f)
      std::memcpy(&out[c][lane], at + 4 * c, sizeof(float));
    else
      out[c][lane] = format == TextureFormat::srgb8_a8 && c < 3 ? kLinearOfSrgb8[at[c]] : float(at[c]) / 255.0f;
  }
}

/// The filtered texels of one level, in f64, of any format and wrap: texel by texel.
inline void filtered_level(const TextureView& texture, const LevelTexels& at, Mask64 valid, V64 rgba[4]) {
  const D64 d;
  const D32 df;
  const size_t lanes = hn::Lanes(d);
  alignas(64) double level[kMostLanes], used[kMostLanes], x[2][kMostLanes], y[2][kMostLanes];
  hn::Store(at.levels, d, level);
  hn::Store(hn::IfThenElseZero(valid, hn::Set(d, 1.0)), d, used);
  for (int k = 0; k < 2; ++k) hn::Store(at.x[k], d, x[k]), hn::Store(at.y[k], d, y[k]);
  const Sampler& s = texture.sampler;
  const float border[4] = {s.border.r, s.border.g, s.border.b, s.border.a};
  const bool nearest = s.mag_filter == Filter::nearest && s.min_filter == Filter::nearest;
  V64 row[2][4];
  for (int j = 0; j < (nearest ? 1 : 2); ++j) {
    V64 side[2][4];
    for (int i = 0; i < (nearest ? 1 : 2); ++i) {
      alignas(64) float texel[4][kMostLanes] = {};
      for (size_t lane = 0; lane < lanes; ++lane)
        if (used[lane] != 0.0)
          fetch(texture.format, texture.level[int(level[lane])], int(x[i][lane]), int(y[j][lane]), border, lane, texel);
      for (size_t c = 0; c < 4; ++c) side[i][c] = hn::PromoteTo(d, hn::Load(df, texel[c]));
    }
    for (size_t c = 0; c < 4; ++c) row[j][c] = nearest ? side[0][c] : mix(side[0][c], side[1][c], at.u_weight);
  }
  for (size_t c = 0; c < 4; ++c) rgba[c] = nearest ? row[0][c] : mix(row[0][c], row[1][c], at.v_weight);
}

inline constexpr uint32_t kRgbBits = 7, kAlphaBit = 8, kRgbaBits = 15;  ///< a bit a channel

/// The channels wanted at places, of the lanes in `valid`; the others mean nothing.
inline void sample(const TextureView& texture, const LookupPlaces& at, Mask64 valid, V32 rgba[4], uint32_t channels) {
  V64 value[4];
  bool quads = false;
  if constexpr (hn::MaxLanes(D64()) > 1) {
    quads = reads_words(texture);
    if (quads) TexelQuads::filter(texture, at, channels, value);
  }
  if (!quads) {
    filtered_level(texture, at.of[0], valid, value);
    if (at.blends) {
      V64 next[4];
      filtered_level(texture, at.of[1], valid, next);
      for (size_t c = 0; c < 4; ++c) value[c] = mix(value[c], next[c], at.part);
    }
  }
  // + 0: what a weight of 0 adds above, so that no lane sees what its neighbours need.
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c)
    if ((channels >> c & 1) != 0) rgba[c] = hn::DemoteTo(D32(), hn::Add(value[c], hn::Zero(D64())));
}

/// The same from texture coordinates.
inline void sample(const TextureView& texture, const UvPoint& at, Mask64 valid, V32 rgba[4], uint32_t channels) {
  MipChoice mip;
  choose_mips<1>(texture, &at, &mip);
  LookupPlaces places{};
  places.set(texture, mip, at.uv, valid);
  sample(texture, places, valid, rgba, channels);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
