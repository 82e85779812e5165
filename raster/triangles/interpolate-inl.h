// The rules of interpolation: weights, attributes and their derivatives at vectors of pixels. This file defines what an
// attribute is at a pixel. Included once per SIMD target. docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_TRIANGLES_INTERPOLATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLES_INTERPOLATE_INL_H_
#undef TRUESHADE_RASTER_TRIANGLES_INTERPOLATE_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLES_INTERPOLATE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "core/simd/lanes-inl.h"
#include "raster/textures/mip_levels-inl.h"
#include "raster/triangles/vertex_stage-inl.h"
#include "scenes/pipeline/pipeline.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Weights of corners 1 and 2 from l_i = E_i / w_i: b_i = l_i r, r = 1 / (l_0 + l_1 + l_2).
struct PerspectiveWeights {
  V64 b1, b2, r;
};
HWY_INLINE PerspectiveWeights perspective_weights(V64 l0, V64 l1, V64 l2) {
  const V64 r = hn::Div(hn::Set(D64(), 1.0), hn::Add(hn::Add(l0, l1), l2));
  return {hn::Mul(l1, r), hn::Mul(l2, r), r};
}

/// An attribute in the triangle's plane: a_0 + (b_1 (a_1 - a_0) + b_2 (a_2 - a_0)), the differences given.
template <class V>
HWY_INLINE V plane_value(V b1, V b2, V a0, V to_1, V to_2) {
  return hn::Add(a0, hn::Add(hn::Mul(b1, to_1), hn::Mul(b2, to_2)));
}

/// An attribute within the hull of its values at the corners.
template <class V>
HWY_INLINE V within_corners(V value, V a0, V a1, V a2) {
  return clamped(value, lesser(lesser(a0, a1), a2), greater(greater(a0, a1), a2));
}

/// The derivative of a perspective weight b = l r, where g is the derivative of l and `sum` that of l_0 + l_1 + l_2.
HWY_INLINE V64 weight_slope(V64 g, V64 b, V64 sum, V64 r) { return hn::Mul(hn::Sub(g, hn::Mul(b, sum)), r); }

/// Rotates three corners, in the lanes of the masks, so that corner 1 or corner 2 comes first.
template <class M, class V>
HWY_INLINE void rotate_corners(M first_is_1, M first_is_2, V corner[3]) {
  const V v0 = corner[0], v1 = corner[1], v2 = corner[2];
  corner[0] = hn::IfThenElse(first_is_2, v2, hn::IfThenElse(first_is_1, v1, v0));
  corner[1] = hn::IfThenElse(first_is_2, v0, hn::IfThenElse(first_is_1, v2, v1));
  corner[2] = hn::IfThenElse(first_is_2, v1, hn::IfThenElse(first_is_1, v0, v2));
}

/// Weights of corners 1 and 2 in canonical order, perspective-correct and linear, and what they were divided by.
struct Barycentrics {
  V64 smooth[2], linear[2];
  V64 r, inverse_area;

  /// The weights of an interpolation that is not flat.
  const V64* of(Interpolation how) const { return how == Interpolation::smooth ? smooth : linear; }
};

/// From the edge functions and 1 / w of the corners; `area` is the edges' exact sum, rounded once.
HWY_INLINE Barycentrics barycentrics(const V64 e[3], const V64 u[3], V64 area) {
  const PerspectiveWeights w = perspective_weights(hn::Mul(e[0], u[0]), hn::Mul(e[1], u[1]), hn::Mul(e[2], u[2]));
  const V64 inverse_area = hn::Div(hn::Set(D64(), 1.0), area);
  return {{w.b1, w.b2}, {hn::Mul(e[1], inverse_area), hn::Mul(e[2], inverse_area)}, w.r, inverse_area};
}

/// How the weights change from a pixel to the next, from the edges' change.
struct BarycentricSlopes {
  V64 smooth[2], linear[2];

  const V64* of(Interpolation how) const { return how == Interpolation::smooth ? smooth : linear; }
};
HWY_INLINE BarycentricSlopes slopes(const Barycentrics& at, const V64 edge_slope[3], const V64 u[3]) {
  const V64 g0 = hn::Mul(edge_slope[0], u[0]), g1 = hn::Mul(edge_slope[1], u[1]), g2 = hn::Mul(edge_slope[2], u[2]);
  const V64 sum = hn::Add(hn::Add(g0, g1), g2);
  return {{weight_slope(g1, at.smooth[0], sum, at.r), weight_slope(g2, at.smooth[1], sum, at.r)},
          {hn::Mul(edge_slope[1], at.inverse_area), hn::Mul(edge_slope[2], at.inverse_area)}};
}

/// How the edge functions of a vector of pixels' triangles change to the next column and row, and 1 / w of the corners.
struct EdgeSlopes {
  V64 along_x[3], along_y[3], u[3];
};

/// Sets the derivatives of texture coordinates, `corner` holding u and v at the corners; a flat coordinate has none.
HWY_INLINE void set_uv_slopes(const Barycentrics& at, const EdgeSlopes& edge, Interpolation how, const V64 corner[2][3],
                              UvPoint& out) {
  const BarycentricSlopes along_x = slopes(at, edge.along_x, edge.u), along_y = slopes(at, edge.along_y, edge.u);
  for (int c = 0; c < 2; ++c) {
    out.x[c] = out.y[c] = hn::Zero(D64());
    if (how == Interpolation::flat) continue;
    const V64 to_1 = hn::Sub(corner[c][1], corner[c][0]), to_2 = hn::Sub(corner[c][2], corner[c][0]);
    const V64 *const x = along_x.of(how), *const y = along_y.of(how);
    out.x[c] = hn::Add(hn::Mul(x[0], to_1), hn::Mul(x[1], to_2));
    out.y[c] = hn::Add(hn::Mul(y[0], to_1), hn::Mul(y[1], to_2));
  }
}

/// An attribute of one triangle at a vector of pixels, from its values at the corners in canonical order. `provoking`:
/// its value where it is flat.
HWY_INLINE V32 triangle_attribute(const Barycentrics& at, Interpolation how, const double corner[3], float provoking) {
  const D64 d;
  if (how == Interpolation::flat) return hn::Set(D32(), provoking);
  const V64 a0 = hn::Set(d, corner[0]), a1 = hn::Set(d, corner[1]), a2 = hn::Set(d, corner[2]);
  const V64* const b = at.of(how);
  return hn::DemoteTo(D32(), within_corners(plane_value(b[0], b[1], a0, hn::Sub(a1, a0), hn::Sub(a2, a0)), a0, a1, a2));
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
