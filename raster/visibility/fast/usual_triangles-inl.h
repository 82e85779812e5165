// The fast paths of a cluster none of whose vertices needs clipping: small triangles a lane each, large ones by windows
// of blocks; and where a sink has neither, triangles between samples are dropped many at a time. Included once per SIMD
// target.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_USUAL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_USUAL_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_USUAL_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_USUAL_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <memory>

#include "raster/visibility/cluster_work-inl.h"
#include "raster/visibility/fast/large_vectors-inl.h"
#include "raster/visibility/fast/small_triangles-inl.h"
#include "raster/visibility/sinks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The thread's scratch.
inline SmallWork& small_work() {
  thread_local const std::unique_ptr<SmallWork> kept = std::make_unique<SmallWork>();
  return *kept;
}

/// Lists the triangles that have area and a sample in their box and the tile, many at a time, in 32-bit integers: in a
/// cluster that spans less than 2^15 subpixels a doubled area stays below 2^31. Returns how many.
inline int sampled_triangles(const ListedCluster& c, const WindowVertices& v, uint8_t* out) {
  const I32 di;
  const hn::Rebind<uint8_t, I32> d8;
  const size_t lanes = hn::Lanes(di);
  const int* const limit = c.rect.limit;
  int count = 0;
  const auto last_x = hn::Set(di, limit[2] - 1), last_y = hn::Set(di, limit[3] - 1);
  const auto low_x = hn::Set(di, limit[0]), low_y = hn::Set(di, limit[1]);
  const auto round_up = hn::Set(di, 255);
  for (size_t t = 0; t < c.cluster.triangles; t += lanes) {
    hn::Vec<I32> x[3], y[3];
    for (size_t k = 0; k < 3; ++k) {
      const auto index = hn::PromoteTo(di, hn::LoadU(d8, c.mesh.corner[k].data() + c.cluster.first_triangle + t));
      const auto vertex = hn::And(index, hn::Set(di, kClusterVertices - 1));
      x[k] = hn::GatherIndex(di, v.x, vertex), y[k] = hn::GatherIndex(di, v.y, vertex);
    }
    const auto flat =
        hn::Eq(hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])), hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])));
    const auto first_x = hn::Max(hn::ShiftRight<8>(hn::Add(hn::Min(hn::Min(x[0], x[1]), x[2]), round_up)), low_x);
    const auto first_y = hn::Max(hn::ShiftRight<8>(hn::Add(hn::Min(hn::Min(y[0], y[1]), y[2]), round_up)), low_y);
    const auto end_x = hn::Min(hn::ShiftRight<8>(hn::Max(hn::Max(x[0], x[1]), x[2])), last_x);
    const auto end_y = hn::Min(hn::ShiftRight<8>(hn::Max(hn::Max(y[0], y[1]), y[2])), last_y);
    const auto rejected = hn::Or(flat, hn::Or(hn::Gt(first_x, end_x), hn::Gt(first_y, end_y)));
    alignas(64) int32_t dropped[16];
    hn::Store(hn::VecFromMask(di, rejected), di, dropped);
    for (size_t i = 0; i < std::min<size_t>(lanes, c.cluster.triangles - t); ++i) {
      out[count] = uint8_t(t + i);
      count += dropped[i] == 0;
    }
  }
  return count;
}

/// Of all triangles in `work.triangle` draws those that it can and drops those that cover nothing; returns how many are
/// left there.
template <class Sink>
HWY_INLINE int draw_usual_triangles(const ListedCluster& c, ClusterWork& work, int count, Sink&) {
  const WindowBox& box = work.vertices.box;
  if (!c.in.fast_paths || std::max(box.x1 - box.x0, box.y1 - box.y0) >= 1 << 15) return count;
  return sampled_triangles(c, work.vertices, work.triangle);
}

HWY_INLINE int draw_usual_triangles(const ListedCluster& c, ClusterWork& work, int count, DepthSink& sink) {
  if (!sink.fast || sink.alpha != nullptr || sink.rule.offsets())
    return draw_usual_triangles<DepthSink>(c, work, count, sink);
  SmallWork& small = small_work();
  const uint32_t first_id = visible_id(c.draw.position, 0, Corners::vertices);
  draw_small_triangles(c, work, DepthFragments{small.fragments, work.vertices.z, first_id, sink}, small);
  return draw_large_triangles({work.vertices, c.state, c.in.view.window.upper_left, c.rect}, small.found.large,
                              small.found.count_large, first_id, sink, work.triangle);
}

HWY_INLINE int draw_usual_triangles(const ListedCluster& c, ClusterWork& work, int count, CountSink<uint32_t>& sink) {
  if (!c.in.fast_paths) return count;
  SmallWork& small = small_work();
  draw_small_triangles(c, work, CountedFragments{small.fragments, sink.counts}, small);
  for (int i = 0; i < small.found.count_large; ++i) work.triangle[i] = uint8_t(uint32_t(small.found.large[i]) >> 24);
  return small.found.count_large;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
