#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include "raster/light_geometry/transformed_mesh.h"
#include "raster/visibility/coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void transform_mesh_simd(const LightMesh& mesh, const Light& light, const View& view, const WindowTransform& window,
                         const int origin_fx[2], TransformedMesh& out) {
  const D32 df;
  const SampleOrigin origin{origin_fx[0], origin_fx[1]};
  const size_t count = mesh.unit.size(), padded = (count + kClusterVertices - 1) / kClusterVertices * kClusterVertices;
  out.world.resize(count);
  light_vertices(mesh, light, out.world);
  for (auto& stream : out.clip) stream.resize(padded);
  out.x.resize(padded), out.y.resize(padded), out.z.resize(padded), out.needs_clip.resize(padded);
  alignas(64) float p[3][kClusterVertices];
  WindowVertices v;
  out.any_needs_clip = false;
  for (size_t from = 0; from < count; from += kClusterVertices) {
    const size_t here = std::min<size_t>(kClusterVertices, count - from);
    const size_t vectors_end = (here + hn::Lanes(df) - 1) / hn::Lanes(df) * hn::Lanes(df);
    for (size_t i = 0; i < vectors_end; ++i)
      for (int c = 0; c < 3; ++c) p[c][i] = out.world[from + std::min(i, here - 1)][c];
    for (size_t i = 0; i < vectors_end; i += hn::Lanes(df)) {
      const V32 x = hn::Load(df, p[0] + i), y = hn::Load(df, p[1] + i), z = hn::Load(df, p[2] + i);
      V32 clip[4];
      for (size_t r = 0; r < 4; ++r) {
        clip[r] = affine_row(view.clip_from_world.data() + 4 * r, x, y, z);
        hn::StoreU(clip[r], df, out.clip[r].data() + from + i);
      }
      const bool outside = project_vertices(clip[0], clip[1], clip[2], clip[3], window, origin, i, v);
      out.any_needs_clip = out.any_needs_clip || outside;
    }
    std::copy_n(v.x, here, out.x.data() + from);
    std::copy_n(v.y, here, out.y.data() + from);
    std::copy_n(v.z, here, out.z.data() + from);
    std::copy_n(v.needs_clip, here, out.needs_clip.data() + from);
  }
}

void count_mesh_simd(const LightMesh& mesh, const TransformedMesh& placed, const GeometryState& state,
                     const WindowTransform& window, const TileRect& rect, uint16_t* counts) {
  CountSink<uint16_t> sink{counts};
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    WindowTriangle triangle;
    ClipVertex clip[3];
    bool clipped = false;
    for (size_t k = 0; k < 3; ++k) {
      const size_t corner = mesh.indices[i + k];
      triangle.x[k] = placed.x[corner];
      triangle.y[k] = placed.y[corner];
      triangle.z[k] = placed.z[corner];
      clipped = clipped || placed.needs_clip[corner] != 0;
      for (size_t c = 0; c < 4; ++c) clip[k].c[c] = placed.clip[c][corner];
    }
    TriangleSetup<double> setup;
    if (clipped)
      draw_clipped(clip, window, sample_origin(rect.x, rect.y), state, rect, sink);
    else if (set_up_triangle(triangle, state, window.upper_left, rect.limit, setup))
      cover_blocks(setup, rect, sink);
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(transform_mesh, HWY_NAMESPACE::transform_mesh_simd);
TRUESHADE_KERNEL(count_mesh, HWY_NAMESPACE::count_mesh_simd);
}  // namespace trueshade
