// Where vectors of lookups read a texture: levels, texels along each axis and weights. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_TEXEL_PLACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TEXEL_PLACES_INL_H_
#undef TRUESHADE_RASTER_TEXEL_PLACES_INL_H_
#else
#define TRUESHADE_RASTER_TEXEL_PLACES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/texture.h"
#include "raster/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Mask64 = hn::Mask<D64>;
inline constexpr size_t kMostLanes = HWY_MAX_BYTES / sizeof(double);

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

/// The level a lookup reads first, an integer, the share of the next one, and whether texels are mixed.
struct MipChoice {
  V64 level, part;
  Mask64 linear;
};

HWY_INLINE MipChoice mip_choice(const TextureView& texture, const UvPoint& at) {
  const D64 d;
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
  return {level, part,
          mag_linear == min_linear ? (mag_linear ? all : none)
          : min_linear             ? minified
                                   : hn::Not(minified)};
}

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
  bool together;  ///< all of one level, each texel's right neighbour the next one: of words alone
  int level;      ///< where together
  alignas(64) uint64_t offset[2][kMostLanes];  ///< where together: of the left texels of both rows, in bytes
  V64 levels, x[2], y[2];                      ///< elsewhere

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
  HWY_INLINE void set_texels(const TextureView& texture, V64 at, bool one_level, const V64 uv[2], Mask64 linear,
                             V64 width, V64 height, V64 inverse_width, V64 inverse_height) {
    const auto& wrap = texture.sampler.wrap;
    if (HWY_LIKELY(wrap[0] == Wrap::repeat && wrap[1] == Wrap::repeat))  // known to the compiler
      set_axes(texture, at, one_level, width, axis_texels(Wrap::repeat, uv[0], width, inverse_width, linear),
               axis_texels(Wrap::repeat, uv[1], height, inverse_height, linear));
    else
      set_axes(texture, at, one_level, width, axis_texels(wrap[0], uv[0], width, inverse_width, linear),
               axis_texels(wrap[1], uv[1], height, inverse_height, linear));
  }

  HWY_INLINE void set_axes(const TextureView& texture, V64 at, bool one_level, V64 width, const AxisTexels& u,
                           const AxisTexels& v) {
    const D64 d;
    const hn::RebindToUnsigned<D64> du;
    u_weight = u.weight, v_weight = v.weight;
    const auto adjoining = hn::Eq(u.second, hn::Add(u.first, hn::Set(d, 1.0)));
    together = hn::MaxLanes(d) > 1 && one_level && reads_words(texture) && hn::AllTrue(d, adjoining);
    if (!together) {
      levels = at, x[0] = u.first, x[1] = u.second, y[0] = v.first, y[1] = v.second;
      return;
    }
    // A double 2^52 + n has the bits of n at its end.
    const V64 four = hn::Set(d, 4.0), line = hn::Mul(width, four);
    const V64 across = hn::Add(hn::Mul(u.first, four), hn::Set(d, 0x1p52));
    const auto exponent = hn::Set(du, 0x4330000000000000u);
    hn::Store(hn::Sub(hn::BitCast(du, hn::Add(hn::Mul(v.first, line), across)), exponent), du, offset[0]);
    hn::Store(hn::Sub(hn::BitCast(du, hn::Add(hn::Mul(v.second, line), across)), exponent), du, offset[1]);
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
