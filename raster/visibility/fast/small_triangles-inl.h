// Triangles whose box holds at most 4x4 samples, a lane a triangle: rejected, covered and tested for depth many at a
// time, with the bits of triangle_setup.h, coverage-inl.h and sinks-inl.h. Included once per SIMD target.
// docs/arithmetic.md sections 4 to 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_SMALL_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/vertex_stage-inl.h"
#include "raster/visibility/cluster_work-inl.h"
#include "raster/visibility/fast/fragment_list-inl.h"
#include "raster/visibility/fast/small_coverage-inl.h"
#include "raster/visibility/fast/triangle_filter-inl.h"
#include "raster/visibility/sinks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

static_assert((64 + 1) * 16 <= kMostFragments);

/// Scratch of a cluster's small triangles.
struct SmallWork {
  alignas(64) int32_t packed[kClusterVertices];
  FilteredTriangles found;
  FragmentList fragments;
};

/// Fragments that are tested for depth.
struct DepthFragments {
  FragmentList& fragments;
  const double* vertex_z;
  uint32_t first_id;  ///< of the cluster's first triangle
  DepthSink& sink;

  HWY_INLINE void make_room(int count) const {
    if (fragments.count + count > int(kMostFragments)) finish();
  }
  HWY_INLINE void finish() const {
    if (fragments.count != 0) test_fragments(fragments, vertex_z, first_id, sink);
  }
};

/// Fragments that are counted.
struct CountedFragments {
  FragmentList& fragments;
  uint32_t* counts;

  HWY_INLINE void make_room(int count) const {
    if (fragments.count + count > int(kMostFragments)) finish();
  }
  HWY_INLINE void finish() const {
    for (int i = 0; i < fragments.count; ++i) ++counts[fragments.at[i]];
    fragments.count = 0;
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
/// `into`: DepthFragments or CountedFragments.
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
      drawn = hn::And(t.present, t.box.upto(4, in.any_clamped));
      count_larger = append(larger, count_larger, hn::AndNot(drawn, t.present), t.word);
      if (hn::AllFalse(d, drawn)) continue;
    }
    cover_small<kSide>(in, OrderedTriangles(t.p0, t.p1, t.p2, t.word), t.box, drawn, into.fragments);
  }
  return count_larger;
}

/// Draws the listed triangles of at most 8x8 samples where enough of a vector is, and lists the rest in `larger`:
/// counter-clockwise ones first, as in a closed mesh they hide the others. Of clamped corners the sign is a guess,
/// which will do: any order draws the same.
template <class Into>
HWY_INLINE int draw_upto_8(const SmallDraw& in, const int32_t* list, int count, const Into& into, int32_t* larger) {
  const DT d;
  const int lanes = int(hn::Lanes(d));
  alignas(64) int32_t back[kMostFiltered];
  int fronts = 0, backs = 0;
  for (int i = 0; i < count; i += lanes) {
    const ListedTriangles t(in, list, count, i);
    auto rest = t.present;
    const auto upto_8 = hn::And(t.present, t.box.upto(8, in.any_clamped));
    if (2 * lane_count(d, upto_8) >= lanes) {
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
/// `small.found.large`. The cluster's vertices are in `work`, and none needs clipping; `work.visible` says which blocks
/// do not hide it. `into`: DepthFragments, without polygon offset, or CountedFragments.
template <class Into>
inline void draw_small_triangles(const ListedCluster& c, const ClusterWork& work, const Into& into, SmallWork& small) {
  const WindowBox& box = work.vertices.box;
  const int32_t middle = c.rect.size * 128, least = middle - kPackedLimit + 1, most = middle + kPackedLimit - 1;
  const bool any_clamped = box.x0 <= least || box.y0 <= least || box.x1 >= most || box.y1 >= most;
  const SmallDraw in{small.packed, any_clamped, c.state, c.in.view.window.upper_left, c.rect, PackedLimits(c.rect)};
  FilteredTriangles& found = small.found;
  pack_corners(work.vertices, c.cluster.vertices, middle, small.packed);
  filter_triangles(small.packed, any_clamped, c.mesh, c.cluster, in.limit, work.visible, found);
  draw_upto<2>(in, found.upto_2, found.count_2, into, nullptr);
  const int larger = draw_upto<4>(in, found.more, found.count_more, into, found.upto_2);
  found.count_large = draw_upto_8(in, found.upto_2, larger, into, found.large);
  into.finish();
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
