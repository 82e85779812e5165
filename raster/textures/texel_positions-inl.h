// The texels that vectors of lookups read along each axis of a level, and their weights. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#undef TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#else
#define TRUESHADE_RASTER_TEXTURES_TEXEL_POSITIONS_INL_H_
#endif

#include <hwy/highway.h>

#include "core/simd/lanes-inl.h"
#include "raster/textures/mip_levels-inl.h"
#include "raster/textures/texture.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
inline constexpr size_t kMostLanes = HWY_MAX_BYTES / sizeof(double);

/// A texture coordinate whose texels can be counted. A float of 2^24 or more is an even integer: the repeating modes
/// read the same texels at 0, and the other modes read far outside the texture.
HWY_INLINE V64 bounded_coordinate(Wrap wrap, V64 coordinate) {
  const D64 d;
  const V64 most = hn::Set(d, 0x1p24);
  const bool repeats = wrap == Wrap::repeat || wrap == Wrap::mirrored_repeat;
  return hn::IfThenElse(hn::Lt(hn::Abs(coordinate), most), coordinate,
                        repeats ? hn::Zero(d) : hn::CopySign(most, coordinate));
}

/// The texel at or below a coordinate, before it is wrapped, and the weight of the texel after it, which is 0 where the
/// filter is nearest.
struct TexelBelow {
  V64 texel, weight;
};
HWY_INLINE TexelBelow texel_below(V64 coordinate, V64 n, M64 linear) {
  const V64 position = hn::Sub(hn::Mul(coordinate, n), hn::IfThenElseZero(linear, hn::Set(D64(), 0.5)));
  const V64 texel = hn::Floor(position);
  return {texel, hn::IfThenElseZero(linear, hn::Sub(position, texel))};
}

/// Texel i modulo a period, whose reciprocal `inverse` is rounded. |i| is below 2^39 and (i + 1/2) / period lies at
/// least 2^-16 from an integer; the computed quotient is less than 2^-27 off.
HWY_INLINE V64 texel_modulo(V64 i, V64 period, V64 inverse) {
  const V64 middle = hn::Add(i, hn::Set(D64(), 0.5));
  return hn::Sub(i, hn::Mul(period, hn::Floor(hn::Mul(middle, inverse))));
}

/// The texel after i in a period.
HWY_INLINE V64 texel_after(V64 i, V64 period) {
  const V64 next = hn::Add(i, hn::Set(D64(), 1.0));
  return hn::IfThenElseZero(hn::Lt(next, period), next);
}

/// Texel i of [0, 2 n) in a texture of n texels that is followed by its mirror image.
HWY_INLINE V64 mirrored_texel(V64 i, V64 n) {
  const V64 last = hn::Sub(hn::Add(n, n), hn::Set(D64(), 1.0));
  return hn::IfThenElse(hn::Lt(i, n), i, hn::Sub(last, i));
}

/// Texel i of a texture that is mirrored at 0 and clamped to its last texel beyond.
HWY_INLINE V64 mirrored_once(V64 i, V64 last) {
  const V64 zero = hn::Zero(D64());
  const V64 mirror = hn::Sub(hn::Neg(hn::Set(D64(), 1.0)), i);
  return clamped(hn::IfThenElse(hn::Lt(i, zero), mirror, i), zero, last);
}

/// The two texels of a coordinate along one axis and the weight of the second.
struct AxisTexels {
  V64 first, second, weight;
};

/// The texels of a side of n, wrapped; -1 and n are the border (GL 4.6 core, table 8.20). `inverse`: 1 / n, rounded.
HWY_INLINE AxisTexels axis_texels(Wrap wrap, V64 coordinate, V64 n, V64 inverse, M64 linear) {
  const D64 d;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0), last = hn::Sub(n, one);
  const auto [below, weight] = texel_below(coordinate, n, linear);
  const V64 next = hn::Add(below, one);
  switch (wrap) {
    case Wrap::repeat: {
      const V64 first = texel_modulo(below, n, inverse);
      return {first, texel_after(first, n), weight};
    }
    case Wrap::mirrored_repeat: {
      const V64 twice = hn::Add(n, n), first = texel_modulo(below, twice, hn::Mul(inverse, hn::Set(d, 0.5)));
      return {mirrored_texel(first, n), mirrored_texel(texel_after(first, twice), n), weight};
    }
    case Wrap::clamp_to_edge:
      return {clamped(below, zero, last), clamped(next, zero, last), weight};
    case Wrap::clamp_to_border:
      return {clamped(below, hn::Neg(one), n), clamped(next, hn::Neg(one), n), weight};
    case Wrap::mirror_clamp_to_edge:
      return {mirrored_once(below, last), mirrored_once(next, last), weight};
  }
  return {below, next, weight};
}

/// The level that each lane reads: its sides and their rounded reciprocals.
struct LevelSides {
  V64 width, height, inverse_width, inverse_height;

  HWY_INLINE LevelSides(const TextureView& texture, V64 level) {
    const D64 d;
    const int first = int(hn::GetLane(level));
    if (HWY_LIKELY(hn::AllTrue(d, hn::Eq(level, hn::Set(d, double(first)))))) {
      const TextureView::Level& l = texture.level[first];
      width = hn::Set(d, double(l.width)), height = hn::Set(d, double(l.height));
      inverse_width = hn::Set(d, l.inverse_width), inverse_height = hn::Set(d, l.inverse_height);
      return;
    }
    alignas(64) double index[kMostLanes], side[4][kMostLanes];
    hn::Store(level, d, index);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const TextureView::Level& l = texture.level[int(index[i])];
      side[0][i] = l.width, side[1][i] = l.height, side[2][i] = l.inverse_width, side[3][i] = l.inverse_height;
    }
    width = hn::Load(d, side[0]), height = hn::Load(d, side[1]);
    inverse_width = hn::Load(d, side[2]), inverse_height = hn::Load(d, side[3]);
  }
};

/// The levels that a vector of lookups reads and the coordinates at which it reads them.
struct LevelsRead {
  V64 uv[2], level[2];  ///< the second level is read where `blends`
  V64 part;             ///< the weight of the second level
  M64 linear;
  bool blends;

  /// Lanes that are not `valid` read the middle of the texture, where no neighbour lies beyond an edge.
  HWY_INLINE LevelsRead(const TextureView& texture, const MipChoice& mip, const V64 at[2], M64 valid)
      : part(mip.part), linear(mip.linear) {
    const D64 d;
    for (size_t k = 0; k < 2; ++k)
      uv[k] = bounded_coordinate(texture.sampler.wrap[k], hn::IfThenElse(valid, at[k], hn::Set(d, 0.5)));
    const V64 last = hn::Set(d, double(texture.levels - 1)), second = hn::Add(mip.level, hn::Set(d, 1.0));
    level[0] = mip.level;
    level[1] = hn::IfThenElse(hn::Gt(second, last), last, second);
    blends =
        texture.sampler.mip_filter == MipFilter::linear && !hn::AllFalse(d, hn::And(valid, hn::Gt(part, hn::Zero(d))));
  }
};

/// a + (b - a) weight, as (1 - w) a + w b: relative precision where a, b >= 0, and a, b themselves at both ends.
HWY_INLINE V64 mix(V64 a, V64 b, V64 weight) {
  return hn::Add(hn::Mul(hn::Sub(hn::Set(D64(), 1.0), weight), a), hn::Mul(weight, b));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
