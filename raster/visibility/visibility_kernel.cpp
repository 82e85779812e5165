#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "raster/visibility/visibility.h"
#include "raster/visibility/coverage-inl.h"
#include "raster/visibility/draw_order-inl.h"
#include "raster/visibility/hierarchical_depth-inl.h"
#include "raster/visibility/fast/large_triangles-inl.h"
#include "raster/visibility/fast/large_vectors-inl.h"
#include "raster/visibility/fast/small_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Triangles that have area and a sample in their box and the tile, many at a time, in 32-bit integers: in a cluster
// that spans less than 2^15 subpixels a doubled area stays below 2^31. Returns how many it wrote to `out`.
int sampled_triangles(const WindowVertices& v, const ClusteredMesh& mesh, const Cluster& cluster, const int limit[4],
               uint8_t* out) {
  const I32 di;
  const hn::Rebind<uint8_t, I32> d8;
  const size_t lanes = hn::Lanes(di);
  int count = 0;
  const auto last_x = hn::Set(di, limit[2] - 1), last_y = hn::Set(di, limit[3] - 1);
  const auto low_x = hn::Set(di, limit[0]), low_y = hn::Set(di, limit[1]);
  const auto round_up = hn::Set(di, 255);
  for (size_t t = 0; t < cluster.triangles; t += lanes) {
    alignas(64) uint8_t corner[3][16] = {};
    const size_t here = std::min<size_t>(lanes, cluster.triangles - t);
    for (size_t k = 0; k < 3; ++k) std::copy_n(&mesh.corner[k][cluster.first_triangle + t], here, corner[k]);
    const auto i0 = hn::PromoteTo(di, hn::Load(d8, corner[0])), i1 = hn::PromoteTo(di, hn::Load(d8, corner[1])),
               i2 = hn::PromoteTo(di, hn::Load(d8, corner[2]));
    const auto x0 = hn::GatherIndex(di, v.x, i0), x1 = hn::GatherIndex(di, v.x, i1), x2 = hn::GatherIndex(di, v.x, i2);
    const auto y0 = hn::GatherIndex(di, v.y, i0), y1 = hn::GatherIndex(di, v.y, i1), y2 = hn::GatherIndex(di, v.y, i2);
    const auto flat = hn::Eq(hn::Mul(hn::Sub(x1, x0), hn::Sub(y2, y0)), hn::Mul(hn::Sub(x2, x0), hn::Sub(y1, y0)));
    const auto first_x = hn::Max(hn::ShiftRight<8>(hn::Add(hn::Min(hn::Min(x0, x1), x2), round_up)), low_x);
    const auto first_y = hn::Max(hn::ShiftRight<8>(hn::Add(hn::Min(hn::Min(y0, y1), y2), round_up)), low_y);
    const auto end_x = hn::Min(hn::ShiftRight<8>(hn::Max(hn::Max(x0, x1), x2)), last_x);
    const auto end_y = hn::Min(hn::ShiftRight<8>(hn::Max(hn::Max(y0, y1), y2)), last_y);
    const auto rejected = hn::Or(flat, hn::Or(hn::Gt(first_x, end_x), hn::Gt(first_y, end_y)));
    alignas(64) int32_t dropped[16];
    hn::Store(hn::VecFromMask(di, rejected), di, dropped);
    for (size_t i = 0; i < here; ++i) {
      out[count] = uint8_t(t + i);
      count += dropped[i] == 0;
    }
  }
  return count;
}

int all_triangles(const Cluster& cluster, uint8_t* out) {
  for (int i = 0; i < cluster.triangles; ++i) out[i] = uint8_t(i);
  return cluster.triangles;
}

// Clip positions of a cluster's vertices, and beyond which sides of the tile they lie. In clip space a side is a half
// space through the eye: a triangle, clipped or not, all of whose corners are outside as seen from its near side covers
// nothing of the tile. With slack for roundings and the snap.
void clip_vertices(const ClusteredMesh& mesh, const Cluster& cluster, const InstanceTransform& instance,
                            const WindowTransform& t, const TileRect& rect, ClipVertices& out) {
  constexpr double kMargin = 2.0;  // pixels
  const D64 d;
  const D32 df;
  const I32 di;
  const double low[2] = {double(rect.x) - kMargin, double(rect.y) - kMargin}, size = rect.size + 2.0 * kMargin;
  for (size_t i = 0; i < cluster.vertices; i += hn::Lanes(d)) {
    V32 p[3], clip[4];
    for (size_t c = 0; c < 3; ++c) p[c] = hn::LoadU(df, mesh.position[c].data() + cluster.first_vertex + i);
    for (int r = 0; r < 4; ++r) {
      clip[r] = affine_row(instance.clip[r], p[0], p[1], p[2]);
      hn::Store(clip[r], df, out.clip[r] + i);
    }
    auto beside = hn::Zero(di);
    for (int axis = 0; axis < 2; ++axis)
      for (int far = 0; far < 2; ++far) {
        // Of w > 0: window coordinate minus edge, times w.
        const double side = far == 0 ? -1.0 : 1.0, edge = low[axis] + far * size;
        const V64 a = hn::Mul(hn::PromoteTo(d, clip[axis]), hn::Set(d, side * double(t.scale[axis]) / 256.0));
        const V64 b = hn::Mul(hn::PromoteTo(d, clip[3]), hn::Set(d, side * (double(t.offset[axis]) / 256.0 - edge)));
        const auto outside = hn::Gt(hn::Add(a, b), hn::Mul(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Set(d, 0x1p-20)));
        const V64 bit = hn::IfThenElseZero(outside, hn::Set(d, double(1 << (2 * axis + far))));
        beside = hn::Or(beside, hn::DemoteTo(di, bit));
      }
    hn::Store(beside, di, out.beside + i);
  }
}

// The alpha test of the cluster's material; null if it has none.
AlphaTest* alpha_test(const TileDraws& in, const Instance& instance, AlphaTest& test) {
  const SceneMaps& maps = in.view.maps;
  if (!maps.textured() || maps.material[instance.material].alpha_cutoff == 0.0f) return nullptr;
  test.maps = &maps.material[instance.material];
  test.uv_how = maps.uv_how;
  test.alpha_how = maps.albedo_how;
  return &test;
}

void set_source(const TileDraws& in, const Instance& instance, const Cluster& cluster, const size_t corner[3],
                AlphaTest& test) {
  uint32_t vertex[3];
  for (size_t k = 0; k < 3; ++k) vertex[k] = in.clusters.meshes[instance.mesh].vertex[cluster.first_vertex + corner[k]];
  test.set_source(in.scene.meshes[instance.mesh], vertex, in.state.provoking == Provoking::last ? 2 : 0);
}

DepthSink& depth_test(DepthSink& sink) { return sink; }
DepthSink& depth_test(FragmentListSink& sink) { return sink.test; }

template <class Sink>
void draw_cluster(const TileDraws& in, const TileRect& rect, const ListedDraw& draw, ClusterScratch& work,
                  Sink& sink, RasterCounts& counts) {
  const uint32_t position = draw.position;
  const WindowTransform& t = in.view.window;
  // Corners' depths bound fragments from below unless an offset may bring these nearer.
  const bool cull = sink.skip_hidden && !t.depth.may_come_nearer();
  if (cull && hidden_draw(sink.tile, rect.size / kBlockSize, draw)) return;
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const Cluster& cluster = mesh.clusters[draw.cluster];
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  const Instance& instance = in.scene.instances[draw.instance];
  AlphaTest* const masked = depth_test(sink).alpha = alpha_test(in, instance, work.alpha);
  WindowVertices& v = work.vertices;
  window_vertices(mesh, cluster, in.view.instances[draw.instance], t, origin, draw.no_clip, v);
  uint8_t* triangle = work.triangle;
  int count = 0;
  if (v.any_needs_clip) {
    clip_vertices(mesh, cluster, in.view.instances[draw.instance], t, rect, work.clip);
    count = all_triangles(cluster, triangle);
  } else {
    const WindowBox& box = v.box;
    const int size = rect.size * 256;
    if (box.x1 < 0 || box.y1 < 0 || box.x0 > size || box.y0 > size) return;
    work.open.all = true;
    if (cull) {
      const BlockBox covered = blocks_of(box, rect);
      const int blocks = rect.size / kBlockSize;
      const float near = near_bound(box.near, t);
      if (covered.count() > cluster.triangles) {
        if (hidden_blocks(sink.tile, blocks, covered, near)) return;
      } else if (!find_visible(sink.tile, blocks, covered, near, work.open)) {
        return;
      }
    }
    const int32_t span = std::max(box.x1 - box.x0, box.y1 - box.y0);
    bool sorted = false;
    if constexpr (std::is_same_v<Sink, DepthSink>) {
      if (sink.fast && masked == nullptr && !t.depth.offsets()) {
        draw_small_triangles(mesh, cluster, box, in.state, t.upper_left, rect, visible_id(position, 0, Corners::vertices), work,
                             sink);
        count = draw_large_triangles({v, in.state, t.upper_left, rect}, work.found.large, work.found.count_large,
                                     visible_id(position, 0, Corners::vertices), sink, triangle);
        sorted = true;
      }
    }
    if (!sorted)
      count = span < (1 << 15) ? sampled_triangles(v, mesh, cluster, rect.limit, triangle) : all_triangles(cluster, triangle);
  }
  ++counts.clusters;
  counts.triangles += uint64_t(cluster.triangles);
  for (int i = 0; i < count; ++i) {
    const size_t at = cluster.first_triangle + triangle[i];
    const size_t corner[3] = {mesh.corner[0][at], mesh.corner[1][at], mesh.corner[2][at]};
    const ClipVertices& placed = work.clip;
    if (in.fast_paths && v.any_needs_clip &&
        (placed.beside[corner[0]] & placed.beside[corner[1]] & placed.beside[corner[2]]) != 0)
      continue;
    const bool clipped =
        v.any_needs_clip && (v.needs_clip[corner[0]] | v.needs_clip[corner[1]] | v.needs_clip[corner[2]]) != 0;
    sink.id = visible_id(position, triangle[i], clipped ? Corners::clipped : Corners::vertices);
    if (masked != nullptr) set_source(in, instance, cluster, corner, work.alpha);
    if (clipped) {
      ClipVertex clip[3];
      for (size_t k = 0; k < 3; ++k)
        for (int r = 0; r < 4; ++r) clip[k].c[r] = placed.clip[r][corner[k]];
      draw_clipped(clip, t, origin, in.state, rect, sink);
      continue;
    }
    WindowTriangle window;
    for (size_t k = 0; k < 3; ++k) {
      window.x[k] = v.x[corner[k]];
      window.y[k] = v.y[corner[k]];
      window.z[k] = v.z[corner[k]];
    }
    if (cull && hidden_triangle(sink.tile, rect, window, t)) continue;
    TriangleSetup<double> setup;
    if (!set_up_triangle(window, in.state, t.upper_left, rect.limit, setup)) continue;
    if (masked != nullptr) {
      const double inverse_w[3] = {v.u[corner[0]], v.u[corner[1]], v.u[corner[2]]};
      work.alpha.set_piece(window, inverse_w);
    }
    if (setup.samples() <= 4)
      cover_samples(setup, rect, sink);
    else
      cover(setup, rect, sink);
  }
}

// Draws upon depths, ids and blocks' largest depths.
void draw_clusters(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out, RasterCounts& counts) {
  const DepthFunc func = in.state.depth_func;
  const bool nearest_wins = func == DepthFunc::less || func == DepthFunc::lequal;
  DepthSink sink{
      out, func, in.view.window.depth_low, in.view.window.depth_high, culling && nearest_wins, in.view.window.depth};
  sink.fast = in.fast_paths && sink.skip_hidden;
  ClusterScratch work;
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

void passing_fragments_simd(const TileDraws& in, const TileRect& rect, DepthFunc func, bool culling,
                            VisibilityTile& visible, std::vector<DepthFragment>& out) {
  out.clear();
  const WindowTransform& t = in.view.window;
  const bool cull = culling && (func == DepthFunc::less || func == DepthFunc::lequal || func == DepthFunc::equal);
  FragmentListSink sink{visible, {visible, func, t.depth_low, t.depth_high, cull, t.depth}, out, cull};
  RasterCounts uncounted;
  ClusterScratch work;
  for (uint32_t i = 0; i < in.list.size(); ++i)
    draw_cluster(in, rect, ListedDraw(in.draws[in.list[i]], i, rect, in.view.window), work, sink, uncounted);
  std::sort(out.begin(), out.end(), [](const DepthFragment& a, const DepthFragment& b) {
    return a.at < b.at || (a.at == b.at && a.id < b.id);
  });
}

void fragments_at_equal_depth_simd(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                                   std::vector<DepthFragment>& out) {
  passing_fragments_simd(in, rect, DepthFunc::equal, culling, visible, out);
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
