#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "raster/visibility/draw_cluster-inl.h"
#include "raster/visibility/draw_order-inl.h"
#include "raster/visibility/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Draws upon depths, ids and blocks' largest depths.
void draw_clusters(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out, RasterCounts& counts) {
  const DepthFunc func = in.state.depth_func;
  const bool nearest_wins = func == DepthFunc::less || func == DepthFunc::lequal;
  DepthSink sink{
      out, func, in.view.window.depth_low, in.view.window.depth_high, culling && nearest_wins, in.view.window.depth};
  sink.fast = in.fast_paths && sink.skip_hidden;
  ClusterWork work;
  if (!sink.skip_hidden) {
    for (uint32_t i = 0; i < in.list.size(); ++i)
      draw_cluster(in, rect, ListedDraw(in.draws[in.list[i]], i, rect, in.view.window), work, sink, counts);
  } else {
    for_each_visible(in, rect, out, !sink.rule.may_come_nearer(),
                     [&](const ListedDraw& listed) { draw_cluster(in, rect, listed, work, sink, counts); });
  }
  counts.fragments += sink.fragments;
}

void draw_visibility_simd(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                          RasterCounts& counts) {
  const size_t pixels = size_t(rect.size) * size_t(rect.size);
  const float clear = in.view.window.depth.stored(in.state.clear_depth);
  std::fill_n(out.depth, pixels, clear);
  std::fill_n(out.id, pixels, 0u);
  std::fill_n(out.far, pixels / kBlockPixels, clear);
  draw_clusters(in, rect, culling, out, counts);
}

void draw_visibility_upon_simd(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                               RasterCounts& counts) {
  for (int block = 0; block < rect.size * rect.size / kBlockPixels; ++block) set_far(out, block);
  draw_clusters(in, rect, culling, out, counts);
}

// Keeps the pixels where not the visible fragment alone has the stored depth.
void keep_shared(const VisibilityTile& visible, std::vector<DepthFragment>& fragments) {
  size_t kept = 0;
  for (size_t i = 0, end = 0; i < fragments.size(); i = end) {
    while (end < fragments.size() && fragments[end].at == fragments[i].at) ++end;
    if (end == i + 1 && fragments[i].id == visible.id[fragments[i].at]) continue;
    for (size_t k = i; k < end; ++k) fragments[kept++] = fragments[k];
  }
  fragments.resize(kept);
}

void list_passing(const TileDraws& in, const TileRect& rect, DepthFunc func, bool culling, VisibilityTile& visible,
                  std::vector<DepthFragment>& out) {
  out.clear();
  const WindowTransform& t = in.view.window;
  const bool cull = culling && (func == DepthFunc::less || func == DepthFunc::lequal || func == DepthFunc::equal);
  FragmentListSink sink{visible, {visible, func, t.depth_low, t.depth_high, cull, t.depth}, out, cull};
  RasterCounts uncounted;
  ClusterWork work;
  for (uint32_t i = 0; i < in.list.size(); ++i)
    draw_cluster(in, rect, ListedDraw(in.draws[in.list[i]], i, rect, in.view.window), work, sink, uncounted);
  std::sort(out.begin(), out.end(), [](const DepthFragment& a, const DepthFragment& b) {
    return a.at < b.at || (a.at == b.at && a.id < b.id);
  });
}

void passing_fragments_simd(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                            std::vector<DepthFragment>& out) {
  list_passing(in, rect, in.state.depth_func, culling, visible, out);
}

void fragments_at_equal_depth_simd(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                                   std::vector<DepthFragment>& out) {
  list_passing(in, rect, DepthFunc::equal, culling, visible, out);
  keep_shared(visible, out);
}

void clip_corners_simd(const TileDraws& in, uint32_t position, uint32_t triangle, ClipVertex v[3]) {
  const ClusterDraw& draw = in.draws[in.list[position]];
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const Cluster& cluster = mesh.clusters[draw.cluster];
  const D32 df;
  for (size_t k = 0; k < 3; ++k) {
    const size_t at = cluster.first_vertex + mesh.corner[k][cluster.first_triangle + triangle];
    for (int r = 0; r < 4; ++r)
      v[k].c[r] = hn::GetLane(affine_row(in.view.instances[draw.instance].clip[r], hn::Set(df, mesh.position[0][at]),
                                         hn::Set(df, mesh.position[1][at]), hn::Set(df, mesh.position[2][at])));
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(draw_visibility, HWY_NAMESPACE::draw_visibility_simd);
TRUESHADE_KERNEL(draw_visibility_upon, HWY_NAMESPACE::draw_visibility_upon_simd);
TRUESHADE_KERNEL(passing_fragments, HWY_NAMESPACE::passing_fragments_simd);
TRUESHADE_KERNEL(fragments_at_equal_depth, HWY_NAMESPACE::fragments_at_equal_depth_simd);
TRUESHADE_KERNEL(clip_corners, HWY_NAMESPACE::clip_corners_simd);
}  // namespace trueshade
