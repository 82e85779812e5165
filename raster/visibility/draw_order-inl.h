// The order in which a tile's clusters are drawn, and what memory is asked for ahead of that. Included once per SIMD
// target. Any order gives the same image.
#if defined(TRUESHADE_RASTER_VISIBILITY_DRAW_ORDER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_DRAW_ORDER_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_DRAW_ORDER_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_DRAW_ORDER_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What a tile reads of a listed cluster before it draws the cluster. These are copies, which lie in memory in the
/// order in which the clusters are drawn.
struct ListedDraw {
  uint32_t position, instance, cluster;
  float near;              ///< what the depth test compares: no fragment is nearer
  uint8_t x0, y0, x1, y1;  ///< blocks that it may touch
  bool no_clip;

  HWY_INLINE ListedDraw(const ClusterDraw& draw, uint32_t at, const TileRect& rect, const WindowTransform& t)
      : position(at),
        instance(draw.instance),
        cluster(draw.cluster),
        near(near_bound(double(draw.near_depth), t)),
        no_clip(draw.no_clip) {
    const BlockBox box = blocks_of(draw, rect);
    x0 = uint8_t(box.x0), y0 = uint8_t(box.y0), x1 = uint8_t(box.x1), y1 = uint8_t(box.y1);
  }
  ListedDraw() = default;
};

/// Whether the tile hides all of a cluster's bounds. If so, the cluster's vertices need not be read.
HWY_INLINE bool hidden_draw(const VisibilityTile& tile, int blocks, const ListedDraw& draw) {
  return hidden_blocks(tile, blocks, {draw.x0, draw.y0, draw.x1, draw.y1}, draw.near);
}

/// Whether the alpha test may leave holes in a cluster.
HWY_INLINE bool is_masked(const TileDraws& in, const ClusterDraw& draw) {
  const SceneMaps& maps = in.view.maps;
  return maps.textured() && maps.material[in.scene.instances[draw.instance].material].alpha_cutoff != 0.0f;
}

/// The listed clusters from the nearest to the farthest, sorted by 256 steps of depth. Then come those of unknown
/// depth: they are large and near the eye, and the others hide much of them. Masked clusters come behind all these, in
/// the same order: they hide little, and their fragments that are hidden by then need no alpha test. The result stays
/// until the thread's next call.
inline std::span<ListedDraw> nearest_first(const TileDraws& in, const TileRect& rect) {
  constexpr int kSteps = 256;
  constexpr size_t kAhead = 48;
  const size_t count = in.list.size();
  thread_local std::vector<float> nearest;
  nearest.resize(std::max(nearest.size(), count));
  float* const near = nearest.data();
  const uint32_t* const list = in.list.data();
  const ClusterDraw* const draws = in.draws.data();
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (size_t i = 0; i < count; ++i) {
    if (i + kAhead < count) hwy::Prefetch(draws + list[i + kAhead]);
    near[i] = draws[list[i]].near_depth;
    high = std::max(high, near[i]);
    if (near[i] > -std::numeric_limits<float>::infinity()) low = std::min(low, near[i]);
  }
  const float scale = high > low ? float(kSteps - 2) / (high - low) : 0.0f;
  const auto step = [&](size_t i) {
    const float z = near[i];
    const int of_depth = z >= low ? std::min(int((z - low) * scale), kSteps - 2) : kSteps - 1;
    return is_masked(in, draws[list[i]]) ? kSteps + of_depth : of_depth;
  };
  uint32_t next[2 * kSteps + 1] = {};
  for (size_t i = 0; i < count; ++i) ++next[step(i) + 1];
  for (int k = 1; k <= 2 * kSteps; ++k) next[k] += next[k - 1];
  thread_local std::vector<ListedDraw> listed;
  listed.resize(std::max(listed.size(), count));
  ListedDraw* const order = listed.data();
  for (size_t i = 0; i < count; ++i)
    order[next[step(i)]++] = ListedDraw(draws[list[i]], uint32_t(i), rect, in.view.window);
  return {order, count};
}

/// Asks memory for what the drawing of a cluster will read of the cluster's instance.
HWY_INLINE void fetch_instance(const TileDraws& in, const ListedDraw& draw) {
  hwy::Prefetch(&in.scene.instances[draw.instance]);
  const InstanceTransform& transform = in.view.instances[draw.instance];
  hwy::Prefetch(transform.clip);
  hwy::Prefetch(transform.clip[3] + 3);
}

/// Prefetches the cluster's header, which tells where its streams are.
HWY_INLINE void fetch_header(const TileDraws& in, const ListedDraw& draw) {
  hwy::Prefetch(&in.clusters.meshes[in.scene.instances[draw.instance].mesh].clusters[draw.cluster]);
}

/// Prefetches the streams of a cluster, as many lines as the largest cluster has: a loop over the cluster's own number
/// of lines would end by a mispredicted branch.
HWY_INLINE void fetch_streams(const TileDraws& in, const ListedDraw& draw) {
  constexpr size_t kLine = 64;
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const Cluster& cluster = mesh.clusters[draw.cluster];
  for (const auto& stream : mesh.position)
    for (size_t i = 0; i < kClusterVertices; i += kLine / sizeof(float))
      hwy::Prefetch(stream.data() + cluster.first_vertex + i);
  for (const auto& stream : mesh.corner)
    for (size_t i = 0; i < kClusterTriangles; i += kLine) hwy::Prefetch(stream.data() + cluster.first_triangle + i);
}

/// Visits the clusters whose bounds the tile does not hide, the nearest first. What a visit reads is prefetched some
/// clusters ahead.
template <class Visit>
HWY_INLINE void for_each_visible(const TileDraws& in, const TileRect& rect, const VisibilityTile& tile, bool cull,
                                 const Visit& visit) {
  constexpr size_t kHeader = 2, kStreams = 4, kDraw = 7;  // clusters after the one whose instance is asked for
  const std::span<ListedDraw> order = nearest_first(in, rect);
  const int blocks = rect.size / kBlockSize;
  size_t open = 0;
  const auto advance = [&](size_t i) {
    if (i >= kHeader && i - kHeader < open) fetch_header(in, order[i - kHeader]);
    if (i >= kStreams && i - kStreams < open) fetch_streams(in, order[i - kStreams]);
    if (i >= kDraw) visit(order[i - kDraw]);
  };
  for (const ListedDraw& listed : order) {
    if (cull && hidden_draw(tile, blocks, listed)) continue;
    fetch_instance(in, listed);
    order[open++] = listed;
    advance(open - 1);
  }
  for (size_t i = open; i < open + kDraw; ++i) advance(i);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
