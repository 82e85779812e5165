// Triangles whose box holds at most 4x4 samples, a lane a triangle: rejected, covered and tested for depth many at a
// time, with the bits of triangle_setup.h, coverage-inl.h and commit-inl.h. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
#if defined(TRUESHADE_RASTER_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SMALL_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_SMALL_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_SMALL_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/candidates-inl.h"
#include "raster/commit-inl.h"
#include "raster/fragment_list-inl.h"
#include "raster/hidden-inl.h"
#include "raster/lanes-inl.h"
#include "raster/triangle_setup.h"
#include "raster/vertex_stage-inl.h"
#include "raster/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

static_assert((64 + 1) * 16 <= kMostFragments);

/// Scratch of draw_cluster(): on the stack of a tile, not of each of its clusters.
struct ClusterScratch {
  WindowVertices vertices;
  AlphaTest alpha;  ///< of the cluster at work, where its material has one
  alignas(64) int32_t packed[kClusterVertices];
  alignas(64) uint8_t triangle[kMostCandidates];
  OpenBlocks open;
  Candidates found;
  FragmentList fragments;
};

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

  /// Those of at most side x side samples, of triangles none of whose corners is held: held ones are at the ends of the
  /// range.
  HWY_INLINE hn::Mask<DT> upto(int side, bool any_held) const {
    const DT d;
    const auto few = hn::Lt(hn::Or(columns, rows), hn::Set(d, side));  // side is a power of two
    if (!any_held) return few;
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
  const VT turned = hn::Add(hn::Xor(swapped, hn::Set(d, -0x10000)), hn::Set(d, 0x10000));  // -x above y
  VT others = hn::Zero(d);
  const VT some =
      hn::ReorderWidenMulAccumulate(d, hn::BitCast(DP(), a), hn::BitCast(DP(), turned), hn::Zero(d), others);
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
    // Owned where dy < 0, and where dy = 0 and dx has the owning sign: then the word is positive and below 2^15.
    const VT word = upper_left ? hn::Xor(along, hn::Set(d, 1 << 15)) : along;
    not_owned = hn::IfThenElseZero(hn::Gt(word, hn::Set(d, (1 << 15) - 1)), hn::Set(d, 1));
    first = hn::Sub(e, not_owned);
    across = hn::ShiftLeft<8>(upper_half(along));
    up = hn::ShiftRight<8>(hn::ShiftLeft<16>(along));
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
  VT word;        ///< as in Candidates

  HWY_INLINE OrderedTriangles(VT p0, VT p1, VT p2, VT named) {
    const DT d;
    const auto from_2 = hn::And(hn::Lt(p2, p0), hn::Lt(p2, p1));
    const auto from_1 = hn::AndNot(hn::Lt(p2, p1), hn::Lt(p1, p0));
    q0 = hn::IfThenElse(from_2, p2, hn::IfThenElse(from_1, p1, p0));
    q1 = hn::IfThenElse(from_2, p0, hn::IfThenElse(from_1, p2, p1));
    q2 = hn::IfThenElse(from_2, p1, hn::IfThenElse(from_1, p0, p2));
    const VT corners = hn::And(named, hn::Set(d, 0xFFFFFF));
    const VT turned_1 = hn::Or(hn::ShiftRight<8>(corners), hn::ShiftLeft<16>(corners));
    const VT turned_2 = hn::Or(hn::ShiftRight<16>(corners), hn::ShiftLeft<8>(corners));
    const VT vertices =
        hn::And(hn::IfThenElse(from_2, turned_2, hn::IfThenElse(from_1, turned_1, corners)), hn::Set(d, 0xFFFFFF));
    word = hn::Or(vertices, hn::AndNot(hn::Set(d, 0xFFFFFF), named));
  }
};

/// What drawing a cluster's small triangles reads.
struct SmallDraw {
  const int32_t* packed;  ///< corners
  bool any_held;
  const GeometryState& state;
  bool upper_left;
  const TileRect& rect;
  const PackedLimits limit;
};

/// Lists the covered samples of a vector of triangles whose boxes hold at most kSide x kSide samples; `which` of them.
template <int kSide>
HWY_INLINE void cover_small(const SmallDraw& in, const OrderedTriangles& triangles, const SampleBoxes& box,
                            hn::Mask<DT> which, FragmentList& out) {
  const DT d;
  const VT zero = hn::Zero(d), named = triangles.word;
  const PackedLimits& limit = in.limit;
  const bool drop_positive = culled(in.state, !in.upper_left), drop_negative = culled(in.state, in.upper_left);
  const VT q0 = triangles.q0, q1 = triangles.q1, q2 = triangles.q2;
  const VT from_q2 = pair_difference(q0, q2), from_q0 = pair_difference(q1, q0);
  const VT area = pair_cross(from_q2, from_q0), size = hn::Abs(area), sign = hn::BroadcastSignBit(area);
  auto drawn = hn::And(which, hn::Ne(area, zero));
  if (drop_positive) drawn = hn::And(drawn, hn::Lt(area, zero));
  if (drop_negative) drawn = hn::And(drawn, hn::Gt(area, zero));

  const VT column = box.column, row = box.row;
  const VT sample = hn::Add(hn::ShiftLeft<24>(row), hn::ShiftLeft<8>(column));
  const auto turned = [sign](VT along) { return pair_difference(hn::Xor(along, sign), sign); };
  const VT along_0 = turned(pair_difference(q2, q1)), along_1 = turned(from_q2), along_2 = turned(from_q0);
  const VT at_1 = pair_cross(along_1, pair_difference(sample, q2)),
           at_2 = pair_cross(along_2, pair_difference(sample, q0));
  SmallEdge e0, e1, e2;  // whose sum is the area
  e0.set(along_0, hn::Sub(size, hn::Add(at_1, at_2)), in.upper_left);
  e1.set(along_1, at_1, in.upper_left);
  e2.set(along_2, at_2, in.upper_left);
  const VT px = hn::Sub(column, hn::Set(d, limit.first_x)), py = hn::Sub(row, hn::Set(d, limit.first_y));
  const VT past_x = hn::Set(d, limit.last_x + 1), past_y = hn::Set(d, limit.last_y + 1);
  VT at_x[kSide];
  for (int x = 0; x < kSide; ++x) at_x[x] = column_index(hn::Add(px, hn::Set(d, x)));
  int n = out.count;
  for (int y = 0; y < kSide; ++y) {
    const VT at_y = row_index(hn::Add(py, hn::Set(d, y)), in.rect.size);
    const auto in_rows = y == 0 ? drawn : hn::And(drawn, hn::Lt(hn::Add(row, hn::Set(d, y)), past_y));
    VT f0 = e0.first, f1 = e1.first, f2 = e2.first;
    for (int x = 0; x < kSide; ++x) {
      auto covered = hn::And(in_rows, hn::Gt(hn::Or(hn::Or(f0, f1), f2), hn::Set(d, -1)));
      if (x > 0) covered = hn::And(covered, hn::Lt(hn::Add(column, hn::Set(d, x)), past_x));
      const uint32_t bits = lane_bits(d, covered);
      if (kSide <= 2 || bits != 0) {  // of few samples there is nearly always one
        const FrontLanes front(d, covered, bits);
        hn::StoreU(front(hn::Add(f1, e1.not_owned)), d, out.e1 + n);
        hn::StoreU(front(hn::Add(f2, e2.not_owned)), d, out.e2 + n);
        hn::StoreU(front(size), d, out.area + n);
        hn::StoreU(front(named), d, out.word + n);
        hn::StoreU(front(hn::Add(at_x[x], at_y)), d, out.at + n);
        n += std::popcount(bits);
      }
      f0 = hn::Sub(f0, e0.across);
      f1 = hn::Sub(f1, e1.across);
      f2 = hn::Sub(f2, e2.across);
    }
    e0.first = hn::Add(e0.first, e0.up);
    e1.first = hn::Add(e1.first, e1.up);
    e2.first = hn::Add(e2.first, e2.up);
  }
  out.count = n;
}

/// Where fragments go.
struct SmallCommit {
  FragmentList& fragments;
  const double* vertex_z;
  uint32_t first_id;  ///< of the cluster's first triangle
  DepthCommit& commit;

  HWY_INLINE void make_room(int count) const {
    if (fragments.count + count > int(kMostFragments)) finish();
  }
  HWY_INLINE void finish() const {
    if (fragments.count != 0) commit_fragments(fragments, vertex_z, first_id, commit);
  }
};

/// A vector of listed triangles.
struct ListedTriangles {
  VT word, p0, p1, p2;
  SampleBoxes box;
  hn::Mask<DT> present;

  HWY_INLINE ListedTriangles(const SmallDraw& in, const int32_t* list, int count, int i)
      : word(hn::Load(DT(), list + i)),
        p0(corner_at(in.packed, word)),
        p1(corner_at(in.packed, hn::ShiftRight<8>(word))),
        p2(corner_at(in.packed, hn::ShiftRight<16>(word))),
        box(p0, p1, p2, in.limit),
        present(hn::FirstN(DT(), size_t(count - i))) {}
};

/// Draws the listed triangles of at most kSide x kSide samples; returns how many larger ones it listed in `larger`.
/// `into`: a SmallCommit, or what else takes fragments.
template <int kSide, class Into>
HWY_INLINE int draw_upto(const SmallDraw& in, const int32_t* list, int count, const Into& into,
                         [[maybe_unused]] int32_t* larger) {
  const DT d;
  const int lanes = int(hn::Lanes(d));
  int count_larger = 0;
  for (int i = 0; i < count; i += lanes) {
    into.make_room((kSide * kSide + 1) * lanes);
    const ListedTriangles t(in, list, count, i);
    auto drawn = t.present;
    if constexpr (kSide == 4) {
      drawn = hn::And(t.present, t.box.upto(4, in.any_held));
      count_larger = append(larger, count_larger, hn::AndNot(drawn, t.present), t.word);
      if (hn::AllFalse(d, drawn)) continue;
    }
    cover_small<kSide>(in, OrderedTriangles(t.p0, t.p1, t.p2, t.word), t.box, drawn, into.fragments);
  }
  return count_larger;
}

/// Draws the listed triangles of at most 8x8 samples where enough of a vector is, and lists the rest in `larger`:
/// counter-clockwise ones first, as in a closed mesh they hide the others. Of held corners the sign is a guess, which
/// will do.
template <class Into>
HWY_INLINE int draw_upto_8(const SmallDraw& in, const int32_t* list, int count, const Into& into, int32_t* larger) {
  const DT d;
  const int lanes = int(hn::Lanes(d));
  alignas(64) int32_t back[kMostCandidates];
  int fronts = 0, backs = 0;
  for (int i = 0; i < count; i += lanes) {
    const ListedTriangles t(in, list, count, i);
    auto rest = t.present;
    const auto upto_8 = hn::And(t.present, t.box.upto(8, in.any_held));
    if (2 * int(hn::CountTrue(d, upto_8)) >= lanes) {
      into.make_room((64 + 1) * lanes);
      cover_small<8>(in, OrderedTriangles(t.p0, t.p1, t.p2, t.word), t.box, upto_8, into.fragments);
      rest = hn::AndNot(upto_8, t.present);
    }
    if (hn::AllFalse(d, rest)) continue;
    const VT x0 = lower_half(t.p0), y0 = upper_half(t.p0);
    const auto front = hn::Gt(hn::Mul(hn::Sub(lower_half(t.p1), x0), hn::Sub(upper_half(t.p2), y0)),
                              hn::Mul(hn::Sub(lower_half(t.p2), x0), hn::Sub(upper_half(t.p1), y0)));
    fronts = append(larger, fronts, hn::And(front, rest), t.word);
    backs = append(back, backs, hn::AndNot(front, rest), t.word);
  }
  std::copy_n(back, backs, larger + fronts);
  return fronts + backs;
}

/// Draws those of a cluster's triangles whose box holds few samples; the others that may cover any are left in
/// `work.found.large`. Its vertices are in `work`, and none needs care; `box` is theirs, `work.open` says which blocks
/// do not hide it. Not under polygon offset.
inline void draw_small_triangles(const ClusteredMesh& mesh, const Cluster& cluster, const WindowBox& box,
                                 const GeometryState& state, bool upper_left, const TileRect& rect, uint32_t first_id,
                                 ClusterScratch& work, DepthCommit& commit) {
  const int32_t middle = rect.size * 128, least = middle - kPackedLimit + 1, most = middle + kPackedLimit - 1;
  const bool any_held = box.x0 <= least || box.y0 <= least || box.x1 >= most || box.y1 >= most;
  const SmallDraw in{work.packed, any_held, state, upper_left, rect, PackedLimits(rect)};
  const SmallCommit into{work.fragments, work.vertices.z, first_id, commit};
  Candidates& found = work.found;
  pack_corners(work.vertices, cluster.vertices, middle, work.packed);
  find_candidates(work.packed, any_held, mesh, cluster, in.limit, work.open, found);
  draw_upto<2>(in, found.upto_2, found.count_2, into, nullptr);
  const int larger = draw_upto<4>(in, found.more, found.count_more, into, found.upto_2);
  found.count_large = draw_upto_8(in, found.upto_2, larger, into, found.large);
  into.finish();
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
