// Triangles a few samples wide, as the bars of light-edges are, under LESS or LEQUAL: a lane a step along the longer
// side of the box, with the bits of triangle_setup.h and sinks-inl.h. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
//
// Across a step a triangle covers an interval no longer than the middle corner is away from the line through the two
// outer ones. Its samples lie among the few that are next to the interval's middle, which floats find to within 1/256
// pixel; the edge functions decide.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_THIN_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_THIN_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_THIN_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_THIN_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raster/visibility/fast/triangle_filter-inl.h"
#include "raster/visibility/sinks-inl.h"
#include "raster/visibility/fast/large_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A vector of LargeSetups as they are swept; "along" and "aside" are columns and rows, or rows and columns.
struct SlenderSetups {
  static constexpr int kMostAside = 4;  ///< samples asked a step; wider triangles are left to others
  alignas(64) float start[LargeSetups::kMost], slope[LargeSetups::kMost];   ///< first sample: floor(start + slope step)
  alignas(64) int32_t first[LargeSetups::kMost], last[LargeSetups::kMost];  ///< steps of the box, inclusive
  alignas(64) int32_t aside[LargeSetups::kMost];                            ///< samples a step
  uint32_t steep, slender;                                                  ///< a bit a triangle: along rows; swept
};

/// Of corners within 4096 pixels, 2^20 units of 1/256: differences are exact below 2^24, the slope is off by 2^-24 at
/// most, its two products with 2^20 and 2^21 and the sums by 1/8 to 1/4 each, the middle by less than 1 unit in all,
/// and at 64 steps by no more than 2^-12 pixel beside. So four units added to the width leave no sample out.
HWY_INLINE void set_up_slender(const LargeSetups& s, const TileRect& rect, SlenderSetups& out) {
  const DT d;
  const DWF df;
  VT x[3], y[3];
  for (int k = 0; k < 3; ++k) x[k] = hn::Load(d, s.x[k]), y[k] = hn::Load(d, s.y[k]);
  const VT left = least_of(x[0], x[1], x[2]), right = most_of(x[0], x[1], x[2]);
  const VT bottom = least_of(y[0], y[1], y[2]), top = most_of(y[0], y[1], y[2]);
  const VT limit = hn::Set(d, 1 << 20);
  const auto near = hn::And(hn::Lt(hn::Max(right, top), limit), hn::Gt(hn::Min(left, bottom), hn::Neg(limit)));
  const auto steep = hn::Gt(hn::Sub(top, bottom), hn::Sub(right, left));
  const VT low = hn::IfThenElse(steep, bottom, left), high = hn::IfThenElse(steep, top, right);

  VT along[3], aside[3];
  for (int k = 0; k < 3; ++k)
    along[k] = hn::IfThenElse(steep, y[k], x[k]), aside[k] = hn::IfThenElse(steep, x[k], y[k]);
  const auto aside_at = [&](VT end) {
    return hn::IfThenElse(hn::Eq(along[0], end), aside[0], hn::IfThenElse(hn::Eq(along[1], end), aside[1], aside[2]));
  };
  const VT at_low = aside_at(low), at_high = aside_at(high);
  const auto sum_but = [](const VT v[3], VT a, VT b) {
    return hn::Sub(hn::Add(hn::Add(v[0], v[1]), v[2]), hn::Add(a, b));
  };
  const auto number = [df](VT v) { return hn::ConvertTo(df, v); };
  const VWF slope = hn::Div(number(hn::Sub(at_high, at_low)), number(hn::Sub(high, low)));
  const VWF off = hn::Sub(number(hn::Sub(sum_but(aside, at_low, at_high), at_low)),
                          hn::Mul(slope, number(hn::Sub(sum_but(along, low, high), low))));
  const VT samples =
      hn::Add(hn::ConvertTo(d, hn::Mul(hn::Add(hn::Abs(off), hn::Set(df, 4.0f)), hn::Set(df, 0x1p-8f))), hn::Set(d, 1));
  const VWF half = hn::Set(df, 0.5f);
  const VWF middle = hn::Add(hn::Sub(number(at_low), hn::Mul(slope, number(low))), hn::Mul(off, half));
  const VWF start =
      hn::Sub(hn::Add(hn::Mul(middle, hn::Set(df, 0x1p-8f)), hn::Set(df, 1.0f)), hn::Mul(number(samples), half));
  hn::Store(start, df, out.start);
  hn::Store(slope, df, out.slope);
  hn::Store(samples, d, out.aside);
  const auto end = [&](int i) {
    return hn::IfThenElse(steep, hn::Set(d, rect.limit[i + 1]), hn::Set(d, rect.limit[i]));
  };
  hn::Store(hn::Max(hn::ShiftRight<8>(hn::Add(low, hn::Set(d, 255))), end(0)), d, out.first);
  hn::Store(hn::Min(hn::ShiftRight<8>(high), hn::Sub(end(2), hn::Set(d, 1))), d, out.last);
  const auto few = hn::Lt(samples, hn::Set(d, SlenderSetups::kMostAside + 1));
  out.steep = lane_bits(d, steep);
  out.slender = lane_bits(d, hn::And(near, few));
}

/// Samples of one triangle: column | row << 8.
struct SlenderSamples {
  static constexpr int kMost = SlenderSetups::kMostAside * kMaxTile;
  alignas(64) int32_t place[kMost + 16];
  int count = 0;
};

/// The covered samples of triangle `t`.
HWY_INLINE void cover_slender(const LargeSetups& s, const SlenderSetups& w, int t, const TileRect& rect,
                              SlenderSamples& out) {
  const DT d;
  const DWF df;
  const int lanes = int(hn::Lanes(d));
  const bool steep = (w.steep >> t & 1) != 0;
  const VT lane = hn::Iota(d, 0);
  VT edge[3], next[3], aside[3];  // at the vector's steps and sample 0; to the next vector; to the next sample
  for (int i = 0; i < 3; ++i) {
    const int32_t along = (steep ? s.up : s.across)[i][t];
    aside[i] = hn::Set(d, (steep ? s.across : s.up)[i][t]);
    edge[i] = hn::Add(hn::Set(d, s.first[i][t] - s.most[i][t] + along * w.first[t]), hn::Mul(lane, hn::Set(d, along)));
    next[i] = hn::Set(d, along * lanes);
  }
  const VT low = hn::Set(d, rect.limit[steep ? 0 : 1] - 1), high = hn::Set(d, rect.limit[steep ? 2 : 3]);
  const VT past = hn::Set(d, w.last[t] + 1), none = hn::Set(d, -1);
  const VWF start = hn::Set(df, w.start[t]), slope = hn::Set(df, w.slope[t]);
  for (int first = w.first[t]; first <= w.last[t]; first += lanes) {
    const VT step = hn::Add(hn::Set(d, first), lane);
    VT at = hn::ConvertTo(d, hn::Floor(hn::Add(start, hn::Mul(slope, hn::ConvertTo(df, step)))));
    VT e[3];
    for (int i = 0; i < 3; ++i) e[i] = hn::Add(edge[i], hn::Mul(at, aside[i])), edge[i] = hn::Add(edge[i], next[i]);
    for (int k = 0; k < w.aside[t]; ++k) {
      const auto inside = hn::And(hn::And(hn::Gt(at, low), hn::Lt(at, high)), hn::Lt(step, past));
      const auto covered = hn::And(inside, hn::Gt(hn::Or(hn::Or(e[0], e[1]), e[2]), none));
      const VT word = steep ? hn::Or(at, hn::ShiftLeft<8>(step)) : hn::Or(step, hn::ShiftLeft<8>(at));
      out.count = append(out.place, out.count, covered, word);
      at = hn::Add(at, hn::Set(d, 1));
      for (int i = 0; i < 3; ++i) e[i] = hn::Add(e[i], aside[i]);
    }
  }
}

/// Depths of a vector of samples of triangle `t`.
HWY_INLINE V32 slender_depths(const LargeSetups& s, int t, const int32_t* place) {
  const D64 d;
  const I32 di;
  const auto word = hn::LoadU(di, place);
  const V64 x = hn::PromoteTo(d, hn::And(word, hn::Set(di, 255))), y = hn::PromoteTo(d, hn::ShiftRight<8>(word));
  V64 e[2];
  for (int i = 0; i < 2; ++i)
    e[i] =
        hn::Add(hn::Set(d, s.c[i][t]), hn::Add(hn::Mul(x, hn::Set(d, s.sx[i][t])), hn::Mul(y, hn::Set(d, s.sy[i][t]))));
  const V64 plane =
      hn::Add(hn::Set(d, s.z0[t]), hn::Add(hn::Mul(e[0], hn::Set(d, s.g1[t])), hn::Mul(e[1], hn::Set(d, s.g2[t]))));
  return hn::DemoteTo(D32(), hn::Min(hn::Max(plane, hn::Set(d, s.low[t])), hn::Set(d, s.high[t])));
}

/// Tests the samples for depth. Blocks keep their largest depths, which are bounds still: what is this slender hides
/// hardly a block.
HWY_INLINE void commit_slender(const LargeSetups& s, int t, int size, SlenderSamples& samples, DepthCommit& commit) {
  const DT d;
  const DWF df;
  const hn::RebindToUnsigned<DT> du;
  constexpr int kLanes = int(hn::MaxLanes(DT())), kHalf = int(hn::MaxLanes(D64()));
  hn::StoreU(hn::Zero(d), d, samples.place + samples.count);
  alignas(64) float z_of[kLanes];
  alignas(64) int32_t at_of[kLanes];
  for (int i = 0; i < samples.count; i += kLanes) {
    const VT word = hn::Load(d, samples.place + i), x = hn::And(word, hn::Set(d, 255)), y = hn::ShiftRight<8>(word);
    const VT at = hn::Add(column_index(x), row_index(y, size));
    const VWF z = commit.stored(
        joined(df, slender_depths(s, t, samples.place + i), slender_depths(s, t, samples.place + i + kLanes - kHalf)));
    const VWF there = hn::GatherIndex(df, commit.tile.depth, at);
    const auto present = hn::FirstN(df, size_t(samples.count - i));
    auto pass = hn::And(present, hn::Lt(z, there));
    const auto tied = hn::And(present, hn::Eq(z, there));
    if (HWY_UNLIKELY(!hn::AllFalse(df, tied))) {
      const auto mine = hn::Set(du, commit.id), other = hn::GatherIndex(du, commit.tile.id, at);
      const auto wins = commit.func == DepthFunc::less ? hn::Lt(mine, other) : hn::Gt(mine, other);
      pass = hn::Or(pass, hn::And(tied, hn::RebindMask(df, wins)));
    }
    hn::Store(z, df, z_of);
    hn::Store(at, d, at_of);
    for (uint32_t bits = lane_bits(df, pass); bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      commit.tile.depth[at_of[k]] = z_of[k];
      commit.tile.id[at_of[k]] = commit.id;
    }
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
