// Reads texels of any format under any wrap mode, one after another, and filters them. This file defines what a lookup
// gives. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_TEXEL_READER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_TEXEL_READER_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_TEXEL_READER_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_TEXEL_READER_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>

#include "core/half.h"
#include "core/srgb.h"
#include "raster/textures/texel_positions-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// RGBA of the texel in column x and row y, or of the border.
HWY_INLINE void fetch_texel(TextureFormat format, const TextureView::Level& level, int x, int y, const float border[4],
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

/// The texels that a vector of lookups reads, each lane of one level: two columns, two rows and their weights.
struct LevelTexels {
  V64 level, x[2], y[2], u_weight, v_weight;

  HWY_INLINE void set(const TextureView& texture, V64 at, const LevelsRead& read) {
    const LevelSides side(texture, at);
    const auto& wrap = texture.sampler.wrap;
    const AxisTexels u = axis_texels(wrap[0], read.uv[0], side.width, side.inverse_width, read.linear);
    const AxisTexels v = axis_texels(wrap[1], read.uv[1], side.height, side.inverse_height, read.linear);
    level = at, x[0] = u.first, x[1] = u.second, y[0] = v.first, y[1] = v.second;
    u_weight = u.weight, v_weight = v.weight;
  }

  /// The filtered texels in f64.
  void filter(const TextureView& texture, M64 valid, V64 rgba[4]) const {
    const D64 d;
    const D32 df;
    const size_t lanes = hn::Lanes(d);
    alignas(64) double index[kMostLanes], used[kMostLanes], column[2][kMostLanes], line[2][kMostLanes];
    hn::Store(level, d, index);
    hn::Store(hn::IfThenElseZero(valid, hn::Set(d, 1.0)), d, used);
    for (int k = 0; k < 2; ++k) hn::Store(x[k], d, column[k]), hn::Store(y[k], d, line[k]);
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
            fetch_texel(texture.format, texture.level[int(index[lane])], int(column[i][lane]), int(line[j][lane]),
                        border, lane, texel);
        for (size_t c = 0; c < 4; ++c) side[i][c] = hn::PromoteTo(d, hn::Load(df, texel[c]));
      }
      for (size_t c = 0; c < 4; ++c) row[j][c] = nearest ? side[0][c] : mix(side[0][c], side[1][c], u_weight);
    }
    for (size_t c = 0; c < 4; ++c) rgba[c] = nearest ? row[0][c] : mix(row[0][c], row[1][c], v_weight);
  }
};

inline constexpr uint32_t kRgbBits = 7, kAlphaBit = 8, kRgbaBits = 15;  ///< a bit a channel

/// The texels of a vector of lookups, found once by set(). read() may follow for each texture that has the sides,
/// levels, bytes a texel and sampler of the texture that set() was given.
class TexelReader {
 public:
  HWY_INLINE void set(const TextureView& texture, const MipChoice& mip, const V64 at[2], M64 valid) {
    const LevelsRead read(texture, mip, at, valid);
    of_[0].set(texture, read.level[0], read);
    part_ = read.part, blends_ = read.blends;
    if (blends_)
      of_[1].set(texture, read.level[1], read);
    else
      of_[1] = of_[0];
  }

  void prefetch(const TextureView&) const {}  ///< a reader may ask for what read() will read

  /// RGBA in f64 of the lanes in `valid`; other lanes mean nothing. A reader may leave out what `channels` lacks.
  HWY_INLINE void read(const TextureView& texture, M64 valid, uint32_t /*channels*/, V64 rgba[4]) const {
    of_[0].filter(texture, valid, rgba);
    if (!blends_) return;
    V64 next[4];
    of_[1].filter(texture, valid, next);
    for (size_t c = 0; c < 4; ++c) rgba[c] = mix(rgba[c], next[c], part_);
  }

 private:
  LevelTexels of_[2];  // the second is read where blends_
  V64 part_;           // the weight of the second
  bool blends_;
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
