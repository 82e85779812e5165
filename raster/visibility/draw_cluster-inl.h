// A cluster's way through a tile: vertices to the window, triangles to setup, samples to a sink. Included once per SIMD
// target. docs/arithmetic.md sections 2 to 6.
#if defined(TRUESHADE_RASTER_VISIBILITY_DRAW_CLUSTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_DRAW_CLUSTER_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_DRAW_CLUSTER_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_DRAW_CLUSTER_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/visibility/cluster_work-inl.h"
#include "raster/visibility/coverage-inl.h"
#include "raster/visibility/fast/clipped_filter-inl.h"   // fast path
#include "raster/visibility/fast/few_samples-inl.h"      // fast path
#include "raster/visibility/fast/usual_triangles-inl.h"  // fast path
#include "raster/visibility/sinks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lists all of a cluster's triangles; returns how many there are.
inline int all_triangles(const Cluster& cluster, uint8_t* out) {
  for (int i = 0; i < cluster.triangles; ++i) out[i] = uint8_t(i);
  return cluster.triangles;
}

/// Clip coordinates of a cluster's vertices, as the vertex stage rounds them.
inline void clip_vertices(const ListedCluster& c, ClipVertices& out) {
  const D32 df;
  for (size_t i = 0; i < c.cluster.vertices; i += hn::Lanes(df)) {
    V32 p[3];
    for (size_t axis = 0; axis < 3; ++axis)
      p[axis] = hn::LoadU(df, c.mesh.position[axis].data() + c.cluster.first_vertex + i);
    for (int r = 0; r < 4; ++r) hn::Store(affine_row(c.transform.clip[r], p[0], p[1], p[2]), df, out.clip[r] + i);
  }
}

/// The alpha test of the cluster's material; null if it has none.
inline AlphaTest* alpha_test(const ListedCluster& c, AlphaTest& test) {
  const SceneMaps& maps = c.in.view.maps;
  if (!maps.textured() || maps.material[c.instance.material].alpha_cutoff == 0.0f) return nullptr;
  test.maps = &maps.material[c.instance.material];
  test.uv_how = maps.uv_how;
  test.alpha_how = maps.albedo_how;
  return &test;
}

inline void set_source(const ListedCluster& c, const size_t corner[3], AlphaTest& test) {
  const size_t first = c.cluster.first_vertex, vertex[3] = {first + corner[0], first + corner[1], first + corner[2]};
  test.set_source(c.in.scene.meshes[c.instance.mesh], c.mesh, vertex, c.state.provoking == Provoking::last ? 2 : 0);
}

/// Draws a triangle of which some vertex needs clipping.
template <class Sink>
HWY_NOINLINE void draw_clipped_triangle(const ListedCluster& c, const ClipVertices& vertices, const size_t corner[3],
                                        Sink& sink) {
  ClipVertex clip[3];
  for (size_t k = 0; k < 3; ++k)
    for (int r = 0; r < 4; ++r) clip[k].c[r] = vertices.clip[r][corner[k]];
  draw_clipped(clip, c.in.view.window, sample_origin(c.rect.x, c.rect.y), c.state, c.rect, sink);
}

/// Draws a triangle none of whose vertices does. `hiding`: the tile whose blocks may hide it, or null.
template <class Sink>
HWY_INLINE void draw_whole_triangle(const ListedCluster& c, const WindowVertices& v, const size_t corner[3],
                                    const VisibilityTile* hiding, AlphaTest* masked, Sink& sink) {
  const WindowTransform& t = c.in.view.window;
  WindowTriangle window;
  for (size_t k = 0; k < 3; ++k) {
    window.x[k] = v.x[corner[k]];
    window.y[k] = v.y[corner[k]];
    window.z[k] = v.z[corner[k]];
  }
  if (hiding != nullptr && hidden_triangle(*hiding, c.rect, window, t)) return;
  TriangleSetup<double> setup;
  if (!set_up_triangle(window, c.state, t.upper_left, c.rect.limit, setup)) return;
  if (masked != nullptr) {
    const double inverse_w[3] = {v.u[corner[0]], v.u[corner[1]], v.u[corner[2]]};
    masked->set_piece(window, inverse_w);
  }
  if (cover_few(setup, c.rect, sink)) return;  // fast path
  cover(setup, c.rect, sink);
}

/// Draws the first `count` triangles of `work.triangle`.
template <class Sink>
HWY_INLINE void draw_triangles(const ListedCluster& c, ClusterWork& work, int count, const VisibilityTile* hiding,
                               AlphaTest* masked, Sink& sink) {
  const WindowVertices& v = work.vertices;
  for (int i = 0; i < count; ++i) {
    const size_t at = c.cluster.first_triangle + work.triangle[i];
    const size_t corner[3] = {c.mesh.corner[0][at], c.mesh.corner[1][at], c.mesh.corner[2][at]};
    const bool clipped =
        v.any_needs_clip && (v.needs_clip[corner[0]] | v.needs_clip[corner[1]] | v.needs_clip[corner[2]]) != 0;
    sink.id = visible_id(c.draw.position, work.triangle[i], clipped ? Corners::clipped : Corners::vertices);
    if (masked != nullptr) set_source(c, corner, *masked);
    if (clipped)
      draw_clipped_triangle(c, work.clip, corner, sink);
    else
      draw_whole_triangle(c, v, corner, hiding, masked, sink);
  }
}

/// Draws a listed cluster into a sink: every triangle, but for those that hierarchical depth hides.
template <class Sink>
void draw_cluster(const TileDraws& in, const TileRect& rect, const ListedDraw& draw, ClusterWork& work, Sink& sink,
                  RasterCounts& counts) {
  const WindowTransform& t = in.view.window;
  // Corners' depths bound fragments from below unless an offset may bring these nearer.
  const VisibilityTile* const hiding = t.depth.may_come_nearer() ? nullptr : sink.hiding();
  if (hiding != nullptr && hidden_draw(*hiding, rect.size / kBlockSize, draw)) return;
  const ListedCluster c(in, rect, draw);
  if (in.clusters.source != nullptr) in.clusters.source->check(in.scene, c.instance, c.mesh, c.cluster);
  AlphaTest* const masked = sink.masked_by(alpha_test(c, work.alpha));
  WindowVertices& v = work.vertices;
  window_vertices(c.mesh, c.cluster, c.transform, t, sample_origin(rect.x, rect.y), draw.no_clip, v);
  int count = 0;
  if (v.any_needs_clip) {
    clip_vertices(c, work.clip);
    count = all_triangles(c.cluster, work.triangle);
    count = drop_beside(c, work, count);  // fast path
  } else {
    const int size = rect.size * 256;
    if (v.box.x1 < 0 || v.box.y1 < 0 || v.box.x0 > size || v.box.y0 > size) return;
    work.visible.all = true;
    if (hiding != nullptr && !find_visible(*hiding, rect, v.box, t, c.cluster.triangles, work.visible)) return;
    count = all_triangles(c.cluster, work.triangle);
    count = draw_usual_triangles(c, work, count, sink);  // fast path
  }
  ++counts.clusters;
  counts.triangles += uint64_t(c.cluster.triangles);
  draw_triangles(c, work, count, hiding, masked, sink);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
