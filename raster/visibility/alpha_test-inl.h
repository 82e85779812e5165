// The alpha test of masked materials, before depth is written. Included once per SIMD target.
// docs/arithmetic.md section 13.
#if defined(TRUESHADE_RASTER_VISIBILITY_ALPHA_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_ALPHA_TEST_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_ALPHA_TEST_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_ALPHA_TEST_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/clusters/clusters.h"
#include "raster/textures/texture-inl.h"
#include "raster/triangles/clipped_fan.h"
#include "raster/triangles/interpolate-inl.h"
#include "raster/triangles/triangle_setup.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One triangle of a masked material at a time. Its values are those of the resolve pass, bit for bit: the same
/// formulas from the same vertices.
struct AlphaTest {
  enum Value { kU, kV, kAlpha, kValues };
  const MaterialMaps* maps = nullptr;
  Interpolation uv_how = Interpolation::smooth, alpha_how = Interpolation::smooth;
  float source[kValues][3];  ///< at the corners as submitted
  float provoking[kValues];
  double value[kValues][3], u[3];  ///< of the piece drawn, canonical order
  double area, slope_x[3], slope_y[3];

  /// A triangle of the material that `maps` are of, its corners as vertices of the mesh's clusters.
  void set_source(const Mesh& mesh, const ClusteredMesh& clusters, const size_t vertex[3], size_t provoking_corner) {
    const UvStreams& uv = mesh.uv_set(maps->color ? maps->color->uv_set : 0);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t corner = clusters.vertex[vertex[k]];
      source[kU][k] = uv[0].empty() ? 0.0f : uv[0][corner];
      source[kV][k] = uv[1].empty() ? 0.0f : uv[1][corner];
      source[kAlpha][k] = surface_value(clusters, vertex[k], 6);
    }
    for (int i = 0; i < kValues; ++i) provoking[i] = source[i][provoking_corner];
  }

  /// A triangle that needed no clipping: its corners are the vertices.
  void set_piece(const WindowTriangle& window, const double inverse_w[3]) {
    int order[3];
    canonical_order(window, order);
    for (int k = 0; k < 3; ++k) {
      u[k] = inverse_w[order[k]];
      for (int i = 0; i < kValues; ++i) value[i][k] = double(source[i][order[k]]);
    }
  }

  /// A piece of one that did.
  void set_piece(const ClipVertex v[3], const ClippedFan& fan, int index, const WindowTransform& t) {
    const ClippedFan::Piece& piece = fan.piece[index];
    int order[3];
    canonical_order(piece.triangle, order);
    for (int k = 0; k < 3; ++k) {
      const int corner = piece.corner[order[k]];
      u[k] = 1.0 / fan.polygon.all[corner].c[3];
      for (int i = 0; i < kValues; ++i)
        value[i][k] = corner_attribute(fan.polygon, corner, v, t, source[i][0], source[i][1], source[i][2]);
    }
  }

  template <class T>
  void set_edges(const TriangleSetup<T>& s) {
    area = double(s.edge(0, 0, 0) + s.edge(1, 0, 0) + s.edge(2, 0, 0));
    for (int i = 0; i < 3; ++i) slope_x[i] = double(s.sx[i]), slope_y[i] = double(s.sy[i]);
  }

  /// Lanes of `asked` whose alpha is not below the cutoff.
  hn::Mask<D32> opaque(const V64 e[3], M64 asked) const {
    const D64 d;
    const D32 df;
    const V64 w[3] = {hn::Set(d, u[0]), hn::Set(d, u[1]), hn::Set(d, u[2])};
    const Barycentrics b = barycentrics(e, w, hn::Set(d, area));
    V32 alpha = triangle_attribute(b, alpha_how, value[kAlpha], provoking[kAlpha]);
    if (maps->color) {
      EdgeSlopes edge;
      V64 corner[2][3];
      for (int i = 0; i < 3; ++i) {
        edge.along_x[i] = hn::Set(d, slope_x[i]), edge.along_y[i] = hn::Set(d, slope_y[i]), edge.u[i] = w[i];
        for (int k = 0; k < 2; ++k) corner[k][i] = hn::Set(d, value[k][i]);
      }
      UvPoint at;
      for (int k = 0; k < 2; ++k) at.uv[k] = hn::PromoteTo(d, triangle_attribute(b, uv_how, value[k], provoking[k]));
      set_uv_slopes(b, edge, uv_how, corner, at);
      V32 rgba[4];
      sample(*maps->color, at, asked, rgba, kAlphaBit);
      alpha = hn::Mul(alpha, rgba[3]);
    }
    alpha = hn::Mul(alpha, hn::Set(df, maps->base_alpha));
    return hn::Ge(alpha, hn::Set(df, maps->alpha_cutoff));
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
