// Where vectors of lookups read a level of a texture: texels along each axis and weights. Included once per SIMD
// target. docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/textures/mip_levels-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
inline constexpr size_t kMostLanes = HWY_MAX_BYTES / sizeof(double);

/// A coordinate's two texels along one axis and the weight of the second, 0 where the filter is nearest.
struct AxisTexels {
  V64 first, second, weight;
};

/// A texture coordinate that texels can be counted from: of 2^24 and more a float is an even integer, for the repeating
/// modes as good as 0, for the others far outside.
HWY_INLINE V64 held_coordinate(Wrap wrap, V64 coordinate) {
  const D64 d;
  const V64 most = hn::Set(d, 0x1p24);
  const bool repeats = wrap == Wrap::repeat || wrap == Wrap::mirrored_repeat;
  return hn::IfThenElse(hn::Lt(hn::Abs(coordinate), most), coordinate,
                        repeats ? hn::Zero(d) : hn::CopySign(most, coordinate));
}

/// Of a side of n texels, wrapped; -1 and n are the border (GL 4.6 core, table 8.20). `inverse`: 1 / n, rounded.
HWY_INLINE AxisTexels axis_texels(Wrap wrap, V64 coordinate, V64 n, V64 inverse, Mask64 linear) {
  const D64 d;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0), half = hn::Set(d, 0.5);
  const V64 texels = hn::Mul(coordinate, n);
  const V64 place = hn::Sub(texels, hn::IfThenElseZero(linear, half));
  const V64 below = hn::Floor(place), next = hn::Add(below, one);
  const V64 weight = hn::IfThenElseZero(linear, hn::Sub(place, below));
  // |i| is below 2^39 and (i + 1/2) / n at least 2^-16 from an integer, its computed value by less than 2^-27 off.
  const auto modulo = [&](V64 i, V64 period, V64 per) {
    return hn::Sub(i, hn::Mul(period, hn::Floor(hn::Mul(hn::Add(i, half), per))));
  };
  const auto after = [&](V64 i, V64 period) {
    const V64 up = hn::Add(i, one);
    return hn::IfThenElse(hn::Lt(up, period), up, zero);
  };
  const auto clamped = [&](V64 i, V64 low, V64 high) {
    const V64 above = hn::IfThenElse(hn::Lt(i, low), low, i);
    return hn::IfThenElse(hn::Gt(above, high), high, above);
  };
  switch (wrap) {
    case Wrap::repeat: {
      const V64 first = modulo(below, n, inverse);
      return {first, after(first, n), weight};
    }
    case Wrap::mirrored_repeat: {
      const V64 twice = hn::Add(n, n), first = modulo(below, twice, hn::Mul(inverse, half));
      const auto mirrored = [&](V64 i) { return hn::IfThenElse(hn::Lt(i, n), i, hn::Sub(hn::Sub(twice, one), i)); };
      return {mirrored(first), mirrored(after(first, twice)), weight};
    }
    case Wrap::clamp_to_edge:
      return {clamped(below, zero, hn::Sub(n, one)), clamped(next, zero, hn::Sub(n, one)), weight};
    case Wrap::clamp_to_border:
      return {clamped(below, hn::Neg(one), n), clamped(next, hn::Neg(one), n), weight};
    case Wrap::mirror_clamp_to_edge: {
      const auto mirrored = [&](V64 i) {
        return clamped(hn::IfThenElse(hn::Lt(i, zero), hn::Sub(hn::Neg(one), i), i), zero, hn::Sub(n, one));
      };
      return {mirrored(below), mirrored(next), weight};
    }
  }
  return {below, next, weight};
}

/// Whether texels have four bytes and lookups never read a border.
inline bool reads_words(const TextureView& texture) {
  const Sampler& s = texture.sampler;
  return bytes_per_texel(texture.format) == 4 && s.wrap[0] != Wrap::clamp_to_border &&
         s.wrap[1] != Wrap::clamp_to_border;
}

/// What lookups read of a level each.
struct LevelTexels {
  V64 u_weight, v_weight;
  bool adjoining;  ///< each texel's right neighbour is the next one: of words alone
  bool together;   ///< and all are of one level
  int level;       ///< where together
  /// Of words: of both rows' left texels and, where not adjoining, right ones, in bytes from each lane's level on.
  alignas(64) uint64_t offset[2][2][kMostLanes];
  alignas(64) uint64_t level_of[kMostLanes];  ///< where not together
  V64 levels, x[2], y[2];                     ///< of all but words

  HWY_INLINE void set(const TextureView& texture, V64 at, const V64 uv[2], Mask64 linear) {
    const D64 d;
    const double first = hn::GetLane(at);
    if (HWY_LIKELY(hn::AllTrue(d, hn::Eq(at, hn::Set(d, first))))) {
      level = int(first);
      const TextureView::Level& l = texture.level[level];
      set_texels(texture, at, true, uv, linear, hn::Set(d, double(l.width)), hn::Set(d, double(l.height)),
                 hn::Set(d, l.inverse_width), hn::Set(d, l.inverse_height));
      return;
    }
    alignas(64) double index[kMostLanes], side[4][kMostLanes];
    hn::Store(at, d, index);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const TextureView::Level& l = texture.level[int(index[i])];
      side[0][i] = l.width, side[1][i] = l.height, side[2][i] = l.inverse_width, side[3][i] = l.inverse_height;
    }
    set_texels(texture, at, false, uv, linear, hn::Load(d, side[0]), hn::Load(d, side[1]), hn::Load(d, side[2]),
               hn::Load(d, side[3]));
  }

 private:
  using DU = hn::RebindToUnsigned<D64>;
  using DW = hn::ScalableTag<uint32_t>;

  HWY_INLINE void set_texels(const TextureView& texture, V64 at, bool one_level, const V64 uv[2], Mask64 linear,
                             V64 width, V64 height, V64 inverse_width, V64 inverse_height) {
    if constexpr (hn::MaxLanes(D64()) > 1)
      if (HWY_LIKELY(texture.masks)) return set_masked(at, one_level, uv, linear, width, height);
    const auto& wrap = texture.sampler.wrap;
    if (HWY_LIKELY(wrap[0] == Wrap::repeat && wrap[1] == Wrap::repeat))  // known to the compiler
      set_axes(texture, at, one_level, width, axis_texels(Wrap::repeat, uv[0], width, inverse_width, linear),
               axis_texels(Wrap::repeat, uv[1], height, inverse_height, linear));
    else
      set_axes(texture, at, one_level, width, axis_texels(wrap[0], uv[0], width, inverse_width, linear),
               axis_texels(wrap[1], uv[1], height, inverse_height, linear));
  }

  /// Of words, both axes repeating and of 2^k texels: what lies within a side are the last bits.
  HWY_INLINE void set_masked(V64 at, bool one_level, const V64 uv[2], Mask64 linear, V64 width, V64 height) {
    const D64 d;
    const DU du;
    const auto one = hn::Set(du, 1);
    const auto below = [&](V64 coordinate, V64 n, V64& weight) {
      const V64 place = hn::Sub(hn::Mul(coordinate, n), hn::IfThenElseZero(linear, hn::Set(d, 0.5)));
      const V64 floor = hn::Floor(place);
      weight = hn::IfThenElseZero(linear, hn::Sub(place, floor));
      return hn::BitCast(du, hn::Add(floor, hn::Set(d, 0x1.8p52)));  // below 2^40, two's complement at the end
    };
    const auto end_x = hn::Sub(integer(width), one), end_y = hn::Sub(integer(height), one);
    const auto u = below(uv[0], width, u_weight), v = below(uv[1], height, v_weight);
    const auto left = hn::And(u, end_x);
    adjoining = hn::AllTrue(du, hn::Ne(left, end_x)), together = adjoining && one_level;
    const auto line = hn::BitCast(DW(), hn::ShiftLeft<2>(integer(width)));
    const auto row = [&](hn::Vec<DU> y) { return hn::MulEven(hn::BitCast(DW(), hn::And(y, end_y)), line); };
    const hn::Vec<DU> rows[2] = {row(v), row(hn::Add(v, one))};
    store_offsets(at, rows, left, hn::And(hn::Add(left, one), end_x));
  }

  HWY_INLINE void set_axes(const TextureView& texture, V64 at, bool one_level, V64 width, const AxisTexels& u,
                           const AxisTexels& v) {
    const D64 d;
    u_weight = u.weight, v_weight = v.weight;
    if (hn::MaxLanes(d) == 1 || !reads_words(texture)) {
      adjoining = together = false;
      levels = at, x[0] = u.first, x[1] = u.second, y[0] = v.first, y[1] = v.second;
      return;
    }
    adjoining = hn::AllTrue(d, hn::Eq(u.second, hn::Add(u.first, hn::Set(d, 1.0)))), together = adjoining && one_level;
    const V64 line = hn::Mul(width, hn::Set(d, 4.0));
    const hn::Vec<DU> rows[2] = {integer(hn::Mul(v.first, line)), integer(hn::Mul(v.second, line))};
    store_offsets(at, rows, integer(u.first), integer(u.second));
  }

  HWY_INLINE void store_offsets(V64 at, const hn::Vec<DU> row[2], hn::Vec<DU> left, hn::Vec<DU> right) {
    const DU du;
    const auto store = [&](int side, hn::Vec<DU> texel) {
      for (int j = 0; j < 2; ++j) hn::Store(hn::Add(row[j], hn::ShiftLeft<2>(texel)), du, offset[j][side]);
    };
    store(0, left);
    if (HWY_LIKELY(together)) return;
    if (!adjoining) store(1, right);
    hn::Store(integer(at), du, level_of);
  }

  /// Of [0, 2^52): a double 2^52 + n has the bits of n at its end.
  static HWY_INLINE hn::Vec<DU> integer(V64 n) {
    const V64 end = hn::Set(D64(), 0x1p52);
    return hn::Sub(hn::BitCast(DU(), hn::Add(n, end)), hn::BitCast(DU(), end));
  }
};

/// What lookups read of a texture. Others with the sides, levels, size of texels and sampler of it are read at the same
/// places.
struct LookupPlaces {
  LevelTexels of[2];  ///< the second where `blends`
  V64 part;           ///< of the second
  bool blends;

  HWY_INLINE void set(const TextureView& texture, const MipChoice& mip, const V64 at[2], Mask64 valid) {
    const D64 d;
    // What is read for nobody is some texel of the middle, where no neighbour lies beyond an edge.
    V64 uv[2];
    for (size_t k = 0; k < 2; ++k)
      uv[k] = held_coordinate(texture.sampler.wrap[k], hn::IfThenElse(valid, at[k], hn::Set(d, 0.5)));
    part = mip.part;
    of[0].set(texture, mip.level, uv, mip.linear);
    blends =
        texture.sampler.mip_filter == MipFilter::linear && !hn::AllFalse(d, hn::And(valid, hn::Gt(part, hn::Zero(d))));
    if (!blends) return;
    const V64 last = hn::Set(d, double(texture.levels - 1)), second = hn::Add(mip.level, hn::Set(d, 1.0));
    of[1].set(texture, hn::IfThenElse(hn::Gt(second, last), last, second), uv, mip.linear);
  }
};

/// a + (b - a) weight, as (1 - w) a + w b: relative precision where a, b >= 0, and a, b themselves at both ends.
HWY_INLINE V64 mix(V64 a, V64 b, V64 weight) {
  return hn::Add(hn::Mul(hn::Sub(hn::Set(D64(), 1.0), weight), a), hn::Mul(weight, b));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
