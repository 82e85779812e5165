#include "raster/overdraw.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/overdraw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "raster/coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void count_cluster(const TileDraws& in, const TileRect& rect, uint32_t position, CountCommit& commit) {
  const ClusterDraw& draw = in.draws[in.list[position]];
  const ClusteredMesh& mesh = in.clusters.meshes[in.scene.instances[draw.instance].mesh];
  const Cluster& cluster = mesh.clusters[draw.cluster];
  const WindowTransform& t = in.view.window;
  const SampleOrigin origin = sample_origin(rect.x, rect.y);
  WindowVertices v;
  window_vertices(mesh, cluster, in.view.instances[draw.instance], t, origin, false, v);
  for (uint32_t i = 0; i < cluster.triangles; ++i) {
    const size_t at = cluster.first_triangle + i;
    WindowTriangle window;
    bool careful = false;
    for (size_t k = 0; k < 3; ++k) {
      const size_t corner = mesh.corner[k][at];
      window.x[k] = v.x[corner];
      window.y[k] = v.y[corner];
      window.z[k] = v.z[corner];
      careful = careful || v.needs_care[corner] != 0;
    }
    if (careful) {
      ClipVertex clip[3];
      clip_corners(in, position, i, clip);
      draw_careful(clip, t, origin, in.state, rect, commit);
      continue;
    }
    TriangleSetup<double> setup;
    if (set_up_triangle(window, in.state, t.upper_left, rect.limit, setup)) cover_blocks(setup, rect, commit);
  }
}

void count_fragments_simd(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  std::fill_n(counts, size_t(rect.size) * size_t(rect.size), 0u);
  CountCommit commit{counts};
  for (uint32_t i = 0; i < in.list.size(); ++i) count_cluster(in, rect, i, commit);
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
