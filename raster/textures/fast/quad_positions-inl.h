// Where lookups of four bytes a texel read: byte offsets of both rows' left and right texels. The texels and weights
// are those of texel_positions-inl.h. Included once per SIMD target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_FAST_QUAD_POSITIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_FAST_QUAD_POSITIONS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_FAST_QUAD_POSITIONS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_FAST_QUAD_POSITIONS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "raster/textures/texel_positions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether lookups go by quads: vectors have lanes, texels have four bytes, and no lookup reads a border.
HWY_INLINE bool reads_quads(const TextureView& texture) {
  return hn::MaxLanes(D64()) > 1 && bytes_per_texel(texture.format) == 4 && !reads_border(texture.sampler);
}

/// The quads of 2x2 texels that a vector of lookups reads, each lane of one level.
struct QuadPositions {
  using DU = hn::RebindToUnsigned<D64>;
  using VU = hn::Vec<DU>;

  V64 u_weight, v_weight;
  bool adjoining;  ///< each right texel lies behind its left one in memory
  bool one_level;  ///< all lanes read the level `first`
  int first;
  VU level;
  alignas(64) uint64_t offset[2][2][kMostLanes];  ///< [row][side][lane], in bytes; the right side only if not adjoining

  HWY_INLINE void set(const TextureView& texture, V64 at, const LevelsRead& read) {
    if (HWY_LIKELY(texture.masks)) return set_masked(texture, at, read);
    const LevelSides side(texture, at);
    const auto& wrap = texture.sampler.wrap;
    set_wrapped(at, side, axis_texels(wrap[0], read.uv[0], side.width, side.inverse_width, read.linear),
                axis_texels(wrap[1], read.uv[1], side.height, side.inverse_height, read.linear));
  }

  /// Asks for the memory of both rows' first and last texels, which a lookup is about to read.
  HWY_INLINE void prefetch(const TextureView& texture) const {
    const uint8_t* const bytes = texture.level[first].bytes;
    for (int j = 0; j < 2; ++j) {
      hwy::Prefetch(bytes + offset[j][0][0]);
      if (HWY_LIKELY(one_level)) hwy::Prefetch(bytes + offset[j][0][hn::MaxLanes(DU()) - 1]);
    }
  }

 private:
  using DW = hn::ScalableTag<uint32_t>;

  /// Both axes repeat and have 2^k texels: the last k bits of a texel's number are its number modulo 2^k. Each level's
  /// sides are half of those of the level before, and 1 or more.
  HWY_INLINE void set_masked(const TextureView& texture, V64 at, const LevelsRead& read) {
    const D64 d;
    const DU du;
    set_level(integer(at));
    const VU one = hn::Set(du, 1);
    const V64 part = hn::BitCast(d, hn::ShiftLeft<52>(hn::Sub(hn::Set(du, 1023), level)));  // 2^-level
    const auto side = [&](int longest) { return greater(hn::Mul(hn::Set(d, double(longest)), part), hn::Set(d, 1.0)); };
    const V64 width = side(texture.level[0].width), height = side(texture.level[0].height);
    const VU last_x = hn::Sub(integer(width), one), last_y = hn::Sub(integer(height), one);
    const TexelBelow u = texel_below(read.uv[0], width, read.linear), v = texel_below(read.uv[1], height, read.linear);
    u_weight = u.weight, v_weight = v.weight;
    const VU left = hn::And(signed_integer(u.texel), last_x), lower = signed_integer(v.texel);
    adjoining = hn::AllTrue(du, hn::Ne(left, last_x));
    const auto line = hn::BitCast(DW(), hn::ShiftLeft<2>(hn::Add(last_x, one)));
    const VU row[2] = {hn::MulEven(hn::BitCast(DW(), hn::And(lower, last_y)), line),
                       hn::MulEven(hn::BitCast(DW(), hn::And(hn::Add(lower, one), last_y)), line)};
    store_offsets(row, left, hn::And(hn::Add(left, one), last_x));
  }

  HWY_INLINE void set_wrapped(V64 at, const LevelSides& side, const AxisTexels& u, const AxisTexels& v) {
    const D64 d;
    set_level(integer(at));
    u_weight = u.weight, v_weight = v.weight;
    adjoining = hn::AllTrue(d, hn::Eq(u.second, hn::Add(u.first, hn::Set(d, 1.0))));
    const V64 line = hn::Mul(side.width, hn::Set(d, 4.0));
    const VU row[2] = {integer(hn::Mul(v.first, line)), integer(hn::Mul(v.second, line))};
    store_offsets(row, integer(u.first), integer(u.second));
  }

  HWY_INLINE void set_level(VU of) {
    level = of;
    first = int(hn::GetLane(of));
    one_level = hn::AllTrue(DU(), hn::Eq(of, hn::Set(DU(), uint64_t(first))));
  }

  HWY_INLINE void store_offsets(const VU row[2], VU left, VU right) {
    for (int j = 0; j < 2; ++j) hn::Store(hn::Add(row[j], hn::ShiftLeft<2>(left)), DU(), offset[j][0]);
    if (HWY_LIKELY(adjoining)) return;
    for (int j = 0; j < 2; ++j) hn::Store(hn::Add(row[j], hn::ShiftLeft<2>(right)), DU(), offset[j][1]);
  }

  /// Of n in [0, 2^52): the double 2^52 + n ends in the bits of n.
  static HWY_INLINE VU integer(V64 n) {
    const V64 end = hn::Set(D64(), 0x1p52);
    return hn::Sub(hn::BitCast(DU(), hn::Add(n, end)), hn::BitCast(DU(), end));
  }
  /// Of |n| below 2^40: the double 2^52 + 2^51 + n ends in the last bits of n in two's complement.
  static HWY_INLINE VU signed_integer(V64 n) { return hn::BitCast(DU(), hn::Add(n, hn::Set(D64(), 0x1.8p52))); }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
