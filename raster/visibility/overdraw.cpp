#include "raster/visibility/overdraw.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/visibility/overdraw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "raster/visibility/coverage-inl.h"
#include "raster/visibility/fast/small_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Counts small triangles' fragments: what a DepthFragments tests for depth.
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

/// What counting a tile's clusters needs.
struct TileCount {
  const TileDraws& in;
  const TileRect& rect;
  uint32_t* counts;
  ClusterScratch& work;

  WindowVertices& vertices() const { return work.vertices; }
};

/// The general path.
void count_triangle(const TileCount& t, const ClusteredMesh& mesh, const Cluster& cluster, uint32_t position,
                    uint32_t triangle) {
  const WindowVertices& v = t.vertices();
  const WindowTransform& window = t.in.view.window;
  const size_t at = cluster.first_triangle + triangle;
  const size_t corner[3] = {mesh.corner[0][at], mesh.corner[1][at], mesh.corner[2][at]};
  CountSink sink{t.counts, t.in.fast_paths};
  if (v.any_needs_clip && (v.needs_clip[corner[0]] | v.needs_clip[corner[1]] | v.needs_clip[corner[2]]) != 0) {
    ClipVertex clip[3];
    clip_corners(t.in, position, triangle, clip);
    draw_clipped(clip, window, sample_origin(t.rect.x, t.rect.y), t.in.state, t.rect, sink);
    return;
  }
  WindowTriangle placed;
  for (size_t k = 0; k < 3; ++k) {
    placed.x[k] = v.x[corner[k]];
    placed.y[k] = v.y[corner[k]];
    placed.z[k] = v.z[corner[k]];
  }
  TriangleSetup<double> setup;
  if (set_up_triangle(placed, t.in.state, window.upper_left, t.rect.limit, setup)) cover(setup, t.rect, sink);
}

/// The paths for usual triangles of a cluster none of whose vertices needs clipping: those of the geometry pass up to where
/// that asks for depths.
void count_usual(const TileCount& t, const ClusteredMesh& mesh, const Cluster& cluster, uint32_t position) {
  const TileRect& rect = t.rect;
  const bool upper_left = t.in.view.window.upper_left;
  const SmallDraw small{t.work.packed, true, t.in.state, upper_left, rect, PackedLimits(rect)};
  const CountedFragments into{t.work.fragments, t.counts};
  FilteredTriangles& found = t.work.found;
  pack_corners(t.vertices(), cluster.vertices, rect.size * 128, t.work.packed);
  filter_triangles(t.work.packed, small.any_clamped, mesh, cluster, small.limit, VisibleBlocks(), found);
  draw_upto<2>(small, found.upto_2, found.count_2, into, nullptr);
  const int more = draw_upto<4>(small, found.more, found.count_more, into, found.upto_2);
  const int large = draw_upto_8(small, found.upto_2, more, into, found.large);
  into.finish();
  for (int i = 0; i < large; ++i) count_triangle(t, mesh, cluster, position, uint32_t(found.large[i]) >> 24);
}

void count_cluster(const TileCount& t, uint32_t position) {
  const ClusterDraw& draw = t.in.draws[t.in.list[position]];
  const ClusteredMesh& mesh = t.in.clusters.meshes[t.in.scene.instances[draw.instance].mesh];
  const Cluster& cluster = mesh.clusters[draw.cluster];
  window_vertices(mesh, cluster, t.in.view.instances[draw.instance], t.in.view.window,
                  sample_origin(t.rect.x, t.rect.y), draw.no_clip, t.vertices());
  if (t.in.fast_paths && !t.vertices().any_needs_clip) return count_usual(t, mesh, cluster, position);
  for (uint32_t i = 0; i < cluster.triangles; ++i) count_triangle(t, mesh, cluster, position, i);
}

void count_fragments_simd(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  std::fill_n(counts, size_t(rect.size) * size_t(rect.size), 0u);
  ClusterScratch work;
  const TileCount count{in, rect, counts, work};
  for (uint32_t i = 0; i < in.list.size(); ++i) count_cluster(count, i);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(count_fragments_simd);

void count_fragments(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  HWY_DYNAMIC_DISPATCH(count_fragments_simd)(in, rect, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
