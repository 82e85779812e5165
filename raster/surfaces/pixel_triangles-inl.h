// Triangles of a vector of pixels, each pixel with its own triangle. Included once per SIMD target.
// docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_PIXEL_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_PIXEL_TRIANGLES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_PIXEL_TRIANGLES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_PIXEL_TRIANGLES_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/surfaces.h"
#include "raster/triangles/interpolate-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using VI32 = hn::Vec<I32>;

/// The triangles of a vector of pixels: corners in canonical order and weights.
struct PixelTriangles {
  VI32 vertex[3];        ///< in VisibleVertices
  V64 x[3], y[3], u[3];  ///< relative to the pixel's sample, in 1/256 pixel; 1 / w
  Barycentrics at;

  /// `corner`: vertices in the order submitted. (px, py): the pixels, relative to the tile.
  PixelTriangles(const VisibleVertices& in, const VI32 corner[3], V64 px, V64 py) {
    const D64 d;
    const I32 di;
    const hn::Rebind<int64_t, D64> dl;
    VI32 wx[3], wy[3];
    for (int i = 0; i < 3; ++i) {
      vertex[i] = corner[i];
      wx[i] = hn::GatherIndex(di, in.x.data(), corner[i]);
      wy[i] = hn::GatherIndex(di, in.y.data(), corner[i]);
    }
    const auto before = [&](int a, int b) {
      return hn::Or(hn::Lt(wy[a], wy[b]), hn::And(hn::Eq(wy[a], wy[b]), hn::Lt(wx[a], wx[b])));
    };
    const auto first_is_1 = hn::And(before(1, 0), hn::Not(before(2, 1)));
    const auto first_is_2 = hn::And(before(2, 0), before(2, 1));
    for (VI32* const of : {vertex, wx, wy}) rotate_corners(first_is_1, first_is_2, of);
    for (int i = 0; i < 3; ++i) {
      x[i] = hn::Sub(hn::PromoteTo(d, wx[i]), hn::Mul(px, hn::Set(d, 256.0)));
      y[i] = hn::Sub(hn::PromoteTo(d, wy[i]), hn::Mul(py, hn::Set(d, 256.0)));
      u[i] = hn::GatherIndex(d, in.u.data(), hn::PromoteTo(dl, vertex[i]));
    }
    V64 e[3];
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      e[i] = hn::Sub(hn::Mul(x[a], y[b]), hn::Mul(x[b], y[a]));
    }
    at = barycentrics(e, u, hn::Add(hn::Add(e[0], e[1]), e[2]));
  }

  /// The edges' slopes, exact.
  EdgeSlopes edge_slopes() const {
    const V64 pixel = hn::Set(D64(), 256.0);
    EdgeSlopes out;
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      out.along_x[i] = hn::Mul(hn::Sub(y[a], y[b]), pixel);
      out.along_y[i] = hn::Mul(hn::Sub(x[b], x[a]), pixel);
      out.u[i] = u[i];
    }
    return out;
  }

  /// An attribute of the pixels, from its values at all vertices. `provoking`: vertices whose values flat ones take.
  V32 attribute(const float* stream, Interpolation how, VI32 provoking) const {
    const D64 d;
    const D32 df;
    if (how == Interpolation::flat) return hn::GatherIndex(df, stream, provoking);
    V32 a[3];
    V64 wide[3];
    for (int k = 0; k < 3; ++k) a[k] = hn::GatherIndex(df, stream, vertex[k]), wide[k] = hn::PromoteTo(d, a[k]);
    const V64* const b = at.of(how);
    const V64 plane = plane_value(b[0], b[1], wide[0], hn::Sub(wide[1], wide[0]), hn::Sub(wide[2], wide[0]));
    return within_corners(hn::DemoteTo(df, plane), a[0], a[1], a[2]);
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
