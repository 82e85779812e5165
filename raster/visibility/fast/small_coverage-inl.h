// Which samples triangles of a few cover, a lane a triangle or a sample, with the bits of triangle_setup.h and
// coverage-inl.h. Included once per SIMD target. docs/arithmetic.md sections 4 to 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_COVERAGE_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_COVERAGE_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_COVERAGE_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "core/simd/lanes-inl.h"
#include "raster/triangles/edge_rule-inl.h"
#include "raster/triangles/edge_vectors-inl.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/visibility/fast/fragment_list-inl.h"
#include "raster/visibility/fast/triangle_filter-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE VT lower_half(VT packed) { return hn::And(packed, hn::Set(DT(), 0xFFFF)); }
HWY_INLINE VT upper_half(VT packed) { return hn::ShiftRight<16>(packed); }
HWY_INLINE VT least_of(VT a, VT b, VT c) { return hn::Min(hn::Min(a, b), c); }
HWY_INLINE VT most_of(VT a, VT b, VT c) { return hn::Max(hn::Max(a, b), c); }

/// The samples of the tile in the boxes of a vector of triangles.
struct SampleBoxes {
  VT column, row;    ///< of the first
  VT columns, rows;  ///< one less than there are; negative where there are none
  VT left, right, bottom, top;

  HWY_INLINE SampleBoxes(VT p0, VT p1, VT p2, const PackedLimits& limit) {
    const DT d;
    const VT x0 = lower_half(p0), x1 = lower_half(p1), x2 = lower_half(p2), round_up = hn::Set(d, 255);
    left = least_of(x0, x1, x2), right = most_of(x0, x1, x2);
    // y above x: the order of whole words is that of y, so their least and most have its.
    bottom = upper_half(least_of(p0, p1, p2)), top = upper_half(most_of(p0, p1, p2));
    column = hn::Max(hn::ShiftRight<8>(hn::Add(left, round_up)), hn::Set(d, limit.low_x));
    row = hn::Max(hn::ShiftRight<8>(hn::Add(bottom, round_up)), hn::Set(d, limit.low_y));
    columns = hn::Sub(hn::Min(hn::ShiftRight<8>(right), hn::Set(d, limit.last_x)), column);
    rows = hn::Sub(hn::Min(hn::ShiftRight<8>(top), hn::Set(d, limit.last_y)), row);
  }

  /// The triangles whose boxes hold at most side x side samples, and none of whose corners is clamped. A clamped corner
  /// lies at an end of the range.
  HWY_INLINE hn::Mask<DT> upto(int side, bool any_clamped) const {
    const DT d;
    const auto few = hn::Lt(hn::Or(columns, rows), hn::Set(d, side));  // side is a power of two
    if (!any_clamped) return few;
    const VT reach = hn::Max(hn::Max(right, hn::Sub(hn::Set(d, 2 * kPackedLimit), left)),
                             hn::Add(hn::Max(top, hn::Neg(bottom)), hn::Set(d, kPackedLimit)));
    return hn::And(few, hn::Lt(reach, hn::Set(d, 2 * kPackedLimit - 1)));
  }
};

/// a - b of packed words, both halves apart.
HWY_INLINE VT pair_difference(VT a, VT b) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Or(hn::ShiftLeft<16>(hn::Sub(upper_half(a), upper_half(b))), lower_half(hn::Sub(a, b)));
#else
  return hn::BitCast(DT(), hn::Sub(hn::BitCast(DP(), a), hn::BitCast(DP(), b)));
#endif
}

/// a.x b.y - a.y b.x of packed differences, y above x.
HWY_INLINE VT pair_cross(VT a, VT b) {
#if HWY_TARGET == HWY_SCALAR
  const auto x = [](VT v) { return upper_half(hn::ShiftLeft<16>(v)); };
  return hn::Sub(hn::Mul(x(a), upper_half(b)), hn::Mul(upper_half(a), x(b)));
#else
  const DT d;
  const hn::RebindToUnsigned<DT> du;
  const VT swapped = hn::Or(hn::ShiftLeft<16>(b), hn::BitCast(d, hn::ShiftRight<16>(hn::BitCast(du, b))));
  const VT quarter = hn::Add(hn::Xor(swapped, hn::Set(d, -0x10000)), hn::Set(d, 0x10000));  // -x above y
  VT others = hn::Zero(d);
  const VT some =
      hn::ReorderWidenMulAccumulate(d, hn::BitCast(DP(), a), hn::BitCast(DP(), quarter), hn::Zero(d), others);
  return hn::RearrangeToOddPlusEven(some, others);
#endif
}

/// An edge function at the first sample of the box, minus 1 where the edge does not own its points: covered where not
/// negative. A column on it is `across` less, a row on `up` more.
struct SmallEdge {
  VT first, across, up, not_owned;  ///< the last 0 or 1

  /// Of an edge function whose edge goes `along` from its first corner to its last.
  HWY_INLINE void set(VT along, VT e, bool upper_left) {
    const DT d;
    across = hn::ShiftLeft<8>(upper_half(along));
    up = hn::ShiftRight<8>(hn::ShiftLeft<16>(along));
    not_owned = hn::IfThenZeroElse(owned_edges(up, across, upper_left), hn::Set(d, 1));
    first = hn::Sub(e, not_owned);
  }
};

/// Place of a pixel in the tile's planes, column and row apart: tile_index() is their sum.
HWY_INLINE VT column_index(VT x) {
  const DT d;
  return hn::Add(hn::ShiftLeft<4>(hn::ShiftRight<2>(x)), hn::And(x, hn::Set(d, 3)));
}
HWY_INLINE VT row_index(VT y, int size) {
  const DT d;
  return hn::Add(hn::Mul(hn::ShiftRight<2>(y), hn::Set(d, size * kBlockSize)),
                 hn::ShiftLeft<2>(hn::And(y, hn::Set(d, 3))));
}

/// A vector of triangles in canonical order: smallest (y, x) first, the others as they follow.
struct OrderedTriangles {
  VT q0, q1, q2;  ///< packed corners
  VT word;        ///< as in FilteredTriangles

  HWY_INLINE OrderedTriangles(VT p0, VT p1, VT p2, VT named) {
    const DT d;
    const auto from_2 = hn::And(hn::Lt(p2, p0), hn::Lt(p2, p1));
    const auto from_1 = hn::AndNot(hn::Lt(p2, p1), hn::Lt(p1, p0));
    q0 = hn::IfThenElse(from_2, p2, hn::IfThenElse(from_1, p1, p0));
    q1 = hn::IfThenElse(from_2, p0, hn::IfThenElse(from_1, p2, p1));
    q2 = hn::IfThenElse(from_2, p1, hn::IfThenElse(from_1, p0, p2));
    const VT corners = hn::And(named, hn::Set(d, 0xFFFFFF));
    const VT rotated_1 = hn::Or(hn::ShiftRight<8>(corners), hn::ShiftLeft<16>(corners));
    const VT rotated_2 = hn::Or(hn::ShiftRight<16>(corners), hn::ShiftLeft<8>(corners));
    const VT vertices =
        hn::And(hn::IfThenElse(from_2, rotated_2, hn::IfThenElse(from_1, rotated_1, corners)), hn::Set(d, 0xFFFFFF));
    word = hn::Or(vertices, hn::AndNot(hn::Set(d, 0xFFFFFF), named));
  }
};

/// What drawing a cluster's small triangles reads.
struct SmallDraw {
  const int32_t* packed;  ///< corners
  bool any_clamped;
  const GeometryState& state;
  bool upper_left;
  const TileRect& rect;
  const PackedLimits limit;
};

/// A vector of triangles, set up: edge functions, whose sum is the area, and the pixel of the first sample.
struct SmallSetups {
  SmallEdge e0, e1, e2;
  VT size, px, py;
  hn::Mask<DT> drawn;  ///< those of `which` that have an area and are not culled

  HWY_INLINE SmallSetups(const SmallDraw& in, const OrderedTriangles& triangles, const SampleBoxes& box,
                         hn::Mask<DT> which) {
    const DT d;
    const VT zero = hn::Zero(d), q0 = triangles.q0, q1 = triangles.q1, q2 = triangles.q2;
    const bool drop_positive = culled(in.state, !in.upper_left), drop_negative = culled(in.state, in.upper_left);
    const VT from_q2 = pair_difference(q0, q2), from_q0 = pair_difference(q1, q0);
    const VT area = pair_cross(from_q2, from_q0), sign = hn::BroadcastSignBit(area);
    size = hn::Abs(area);
    drawn = hn::And(which, hn::Ne(area, zero));
    if (drop_positive) drawn = hn::And(drawn, hn::Lt(area, zero));
    if (drop_negative) drawn = hn::And(drawn, hn::Gt(area, zero));
    const VT sample = hn::Add(hn::ShiftLeft<24>(box.row), hn::ShiftLeft<8>(box.column));
    const auto oriented = [sign](VT along) { return pair_difference(hn::Xor(along, sign), sign); };
    const VT along_0 = oriented(pair_difference(q2, q1)), along_1 = oriented(from_q2), along_2 = oriented(from_q0);
    const VT at_1 = pair_cross(along_1, pair_difference(sample, q2)),
             at_2 = pair_cross(along_2, pair_difference(sample, q0));
    e0.set(along_0, hn::Sub(size, hn::Add(at_1, at_2)), in.upper_left);
    e1.set(along_1, at_1, in.upper_left);
    e2.set(along_2, at_2, in.upper_left);
    px = hn::Sub(box.column, hn::Set(d, in.limit.first_x)), py = hn::Sub(box.row, hn::Set(d, in.limit.first_y));
  }
};

/// Lists the covered samples of triangles whose boxes hold at most kSide x kSide samples, a lane a triangle.
template <int kSide>
HWY_INLINE void cover_lanes(const SmallDraw& in, SmallSetups& s, const SampleBoxes& box, VT named, FragmentList& out) {
  const DT d;
  const PackedLimits& limit = in.limit;
  const VT past_x = hn::Set(d, limit.last_x + 1), past_y = hn::Set(d, limit.last_y + 1);
  VT at_x[kSide];
  for (int x = 0; x < kSide; ++x) at_x[x] = column_index(hn::Add(s.px, hn::Set(d, x)));
  int n = out.count;
  for (int y = 0; y < kSide; ++y) {
    const VT at_y = row_index(hn::Add(s.py, hn::Set(d, y)), in.rect.size);
    const auto in_rows = y == 0 ? s.drawn : hn::And(s.drawn, hn::Lt(hn::Add(box.row, hn::Set(d, y)), past_y));
    VT f0 = s.e0.first, f1 = s.e1.first, f2 = s.e2.first;
    for (int x = 0; x < kSide; ++x) {
      auto covered = hn::And(in_rows, hn::Gt(hn::Or(hn::Or(f0, f1), f2), hn::Set(d, -1)));
      if (x > 0) covered = hn::And(covered, hn::Lt(hn::Add(box.column, hn::Set(d, x)), past_x));
      const uint32_t bits = lane_bits(d, covered);
      if (kSide <= 2 || bits != 0) {  // of few samples there is nearly always one
        const FrontLanes front(d, covered, bits);
        hn::StoreU(front(hn::Add(f1, s.e1.not_owned)), d, out.e1 + n);
        hn::StoreU(front(hn::Add(f2, s.e2.not_owned)), d, out.e2 + n);
        hn::StoreU(front(s.size), d, out.area + n);
        hn::StoreU(front(named), d, out.word + n);
        hn::StoreU(front(hn::Add(at_x[x], at_y)), d, out.at + n);
        n += std::popcount(bits);
      }
      f0 = hn::Sub(f0, s.e0.across);
      f1 = hn::Sub(f1, s.e1.across);
      f2 = hn::Sub(f2, s.e2.across);
    }
    s.e0.first = hn::Add(s.e0.first, s.e0.up);
    s.e1.first = hn::Add(s.e1.first, s.e1.up);
    s.e2.first = hn::Add(s.e2.first, s.e2.up);
  }
  out.count = n;
}

/// The same for boxes of at most 4x4 samples, a lane a sample and a triangle after the other: by lanes of few triangles
/// most of a sample's are none's, and whether any is is not foreseen.
HWY_INLINE void cover_one_by_one(const SmallDraw& in, const SmallSetups& s, const SampleBoxes& box, VT named,
                                 FragmentList& out) {
  const DT d;
  alignas(64) int32_t first[3][kBlockPixels], across[3][kBlockPixels], up[3][kBlockPixels], not_owned[2][kBlockPixels];
  alignas(64) int32_t size[kBlockPixels], word[kBlockPixels], px[kBlockPixels], py[kBlockPixels], columns[kBlockPixels],
      rows[kBlockPixels];
  const SmallEdge* const edge[3] = {&s.e0, &s.e1, &s.e2};
  for (int k = 0; k < 3; ++k) {
    hn::Store(edge[k]->first, d, first[k]);
    hn::Store(edge[k]->across, d, across[k]);
    hn::Store(edge[k]->up, d, up[k]);
    if (k > 0) hn::Store(edge[k]->not_owned, d, not_owned[k - 1]);
  }
  hn::Store(s.size, d, size);
  hn::Store(named, d, word);
  hn::Store(s.px, d, px);
  hn::Store(s.py, d, py);
  hn::Store(box.columns, d, columns);
  hn::Store(box.rows, d, rows);
  const VT x = hn::Load(d, kPixelColumn), y = hn::Load(d, kPixelRow);
  int n = out.count;
  for (uint32_t bits = lane_bits(d, s.drawn); bits != 0; bits &= bits - 1) {
    const int t = std::countr_zero(bits);
    VT f[3];
    for (int k = 0; k < 3; ++k)
      f[k] = hn::Add(hn::Sub(hn::Set(d, first[k][t]), hn::Mul(x, hn::Set(d, across[k][t]))),
                     hn::Mul(y, hn::Set(d, up[k][t])));
    const auto here = hn::And(hn::Not(hn::Gt(x, hn::Set(d, columns[t]))), hn::Not(hn::Gt(y, hn::Set(d, rows[t]))));
    const auto covered = hn::And(here, hn::Gt(hn::Or(hn::Or(f[0], f[1]), f[2]), hn::Set(d, -1)));
    const VT at =
        hn::Add(column_index(hn::Add(x, hn::Set(d, px[t]))), row_index(hn::Add(y, hn::Set(d, py[t])), in.rect.size));
    const uint32_t samples = lane_bits(d, covered);
    const FrontLanes front(d, covered, samples);
    hn::StoreU(front(hn::Add(f[1], hn::Set(d, not_owned[0][t]))), d, out.e1 + n);
    hn::StoreU(front(hn::Add(f[2], hn::Set(d, not_owned[1][t]))), d, out.e2 + n);
    hn::StoreU(hn::Set(d, size[t]), d, out.area + n);
    hn::StoreU(hn::Set(d, word[t]), d, out.word + n);
    hn::StoreU(front(at), d, out.at + n);
    n += std::popcount(samples);
  }
  out.count = n;
}

/// Lists the covered samples of a vector of triangles whose boxes hold at most kSide x kSide samples; `which` of them.
template <int kSide>
HWY_INLINE void cover_small(const SmallDraw& in, const OrderedTriangles& triangles, const SampleBoxes& box,
                            hn::Mask<DT> which, FragmentList& out) {
  constexpr int kFew = 10;  // from there on lanes are as fast
  SmallSetups setups(in, triangles, box, which);
  if constexpr (kSide == 4 && hn::MaxLanes(DT()) == kBlockPixels)
    if (lane_count(DT(), setups.drawn) <= kFew) return cover_one_by_one(in, setups, box, triangles.word, out);
  cover_lanes<kSide>(in, setups, box, triangles.word, out);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
