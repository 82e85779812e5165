// Triangles that lie beyond one side of the tile are dropped before they are clipped. Included once per SIMD target.
//
// In clip space a side of the tile is a half space through the eye: a triangle, clipped or not, all of whose corners
// are outside as seen from the side's near edge covers nothing of the tile. A margin and a slack allow for roundings
// and the snap.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_CLIPPED_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_CLIPPED_FILTER_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_CLIPPED_FILTER_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_CLIPPED_FILTER_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/visibility/cluster_work-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sets a bit for each side of the tile that a vertex lies beyond.
inline void find_sides(const ListedCluster& c, const ClipVertices& vertices, int32_t* beside_of) {
  constexpr double kMargin = 2.0;  // pixels
  const D64 d;
  const D32 df;
  const I32 di;
  const WindowTransform& t = c.in.view.window;
  const double low[2] = {double(c.rect.x) - kMargin, double(c.rect.y) - kMargin}, size = c.rect.size + 2.0 * kMargin;
  for (size_t i = 0; i < c.cluster.vertices; i += hn::Lanes(d)) {
    const V64 w = hn::PromoteTo(d, hn::Load(df, vertices.clip[3] + i));
    auto beside = hn::Zero(di);
    for (int axis = 0; axis < 2; ++axis)
      for (int far = 0; far < 2; ++far) {
        // Where w > 0 the sum a + b is the window coordinate minus the side's, times w.
        const double side = far == 0 ? -1.0 : 1.0, edge = low[axis] + far * size;
        const V64 a = hn::Mul(hn::PromoteTo(d, hn::Load(df, vertices.clip[axis] + i)),
                              hn::Set(d, side * double(t.scale[axis]) / 256.0));
        const V64 b = hn::Mul(w, hn::Set(d, side * (double(t.offset[axis]) / 256.0 - edge)));
        const auto outside = hn::Gt(hn::Add(a, b), hn::Mul(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Set(d, 0x1p-20)));
        const V64 bit = hn::IfThenElseZero(outside, hn::Set(d, double(1 << (2 * axis + far))));
        beside = hn::Or(beside, hn::DemoteTo(di, bit));
      }
    hn::Store(beside, di, beside_of + i);
  }
}

/// Of the listed triangles keeps those that are not beyond one side; returns how many.
inline int drop_beside(const ListedCluster& c, ClusterWork& work, int count) {
  if (!c.in.fast_paths) return count;
  alignas(64) int32_t beside[kClusterVertices];
  find_sides(c, work.clip, beside);
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const size_t at = c.cluster.first_triangle + work.triangle[i];
    const int32_t all = beside[c.mesh.corner[0][at]] & beside[c.mesh.corner[1][at]] & beside[c.mesh.corner[2][at]];
    if (all == 0) work.triangle[kept++] = work.triangle[i];
  }
  return kept;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
