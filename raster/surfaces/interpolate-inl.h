// Perspective-correct, linear and flat attributes of vectors of pixels. Included once per SIMD target.
// docs/arithmetic.md section 5.
#if defined(TRUESHADE_RASTER_SURFACES_INTERPOLATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_INTERPOLATE_INL_H_
#undef TRUESHADE_RASTER_SURFACES_INTERPOLATE_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_INTERPOLATE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/surfaces/surfaces.h"
#include "raster/textures/texture-inl.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using VI32 = hn::Vec<I32>;

/// Weights of vertices 1 and 2 in canonical order, and what they were divided by.
struct Barycentrics {
  V64 smooth[2], linear[2];
  V64 r, inverse_area;
};

/// From the edge functions and 1 / w of the vertices; `area` is the edges' exact sum, rounded once.
HWY_INLINE Barycentrics barycentrics(const V64 e[3], const V64 u[3], V64 area) {
  const V64 one = hn::Set(D64(), 1.0);
  const V64 l0 = hn::Mul(e[0], u[0]), l1 = hn::Mul(e[1], u[1]), l2 = hn::Mul(e[2], u[2]);
  const V64 r = hn::Div(one, hn::Add(hn::Add(l0, l1), l2));
  const V64 inverse_area = hn::Div(one, area);
  return {
      {hn::Mul(l1, r), hn::Mul(l2, r)}, {hn::Mul(e[1], inverse_area), hn::Mul(e[2], inverse_area)}, r, inverse_area};
}

/// How the weights change from a pixel to the next, from the edges' change.
struct BarycentricSlopes {
  V64 smooth[2], linear[2];
};
HWY_INLINE BarycentricSlopes slopes(const Barycentrics& at, const V64 edge_slope[3], const V64 u[3]) {
  const V64 g0 = hn::Mul(edge_slope[0], u[0]), g1 = hn::Mul(edge_slope[1], u[1]), g2 = hn::Mul(edge_slope[2], u[2]);
  const V64 sum = hn::Add(hn::Add(g0, g1), g2);
  return {
      {hn::Mul(hn::Sub(g1, hn::Mul(at.smooth[0], sum)), at.r), hn::Mul(hn::Sub(g2, hn::Mul(at.smooth[1], sum)), at.r)},
      {hn::Mul(edge_slope[1], at.inverse_area), hn::Mul(edge_slope[2], at.inverse_area)}};
}

/// b1 (a1 - a0) + b2 (a2 - a0).
HWY_INLINE V64 affine_slope(const V64 b[2], V64 a0, V64 a1, V64 a2) {
  return hn::Add(hn::Mul(b[0], hn::Sub(a1, a0)), hn::Mul(b[1], hn::Sub(a2, a0)));
}

/// a0 + (b1 (a1 - a0) + b2 (a2 - a0)).
HWY_INLINE V64 affine(const V64 b[2], V64 a0, V64 a1, V64 a2) {
  return hn::Add(a0, hn::Add(hn::Mul(b[0], hn::Sub(a1, a0)), hn::Mul(b[1], hn::Sub(a2, a0))));
}

/// Barycentrics of pixels whose triangles differ, and where the vertices are in VisibleVertices, in canonical order.
struct Weights {
  VI32 vertex[3];
  Barycentrics at;
  V64 x[3], y[3], u[3];  ///< relative to the pixel, 1/256 pixel; 1 / w
};

/// Smaller and larger of two, the first where equal or a NaN is among them: the same answer for -0 and 0 on every
/// target. x86 has instructions of that very meaning, though it takes the second, behind Min and Max of more than a
/// lane; elsewhere these make other choices.
inline constexpr bool kMinTakesSecond = HWY_ARCH_X86 && hn::MaxLanes(D32()) > 1;
template <class V>
HWY_INLINE V lesser(V a, V b) {
  if constexpr (kMinTakesSecond)
    return hn::Min(b, a);
  else
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V greater(V a, V b) {
  if constexpr (kMinTakesSecond)
    return hn::Max(b, a);
  else
    return hn::IfThenElse(hn::Gt(b, a), b, a);
}

HWY_INLINE Weights weights(const VisibleVertices& in, const VI32 corner[3], V64 px, V64 py) {
  const D64 d;
  const I32 di;
  const hn::Rebind<int64_t, D64> dl;
  VI32 x[3], y[3];
  for (int i = 0; i < 3; ++i) {
    x[i] = hn::GatherIndex(di, in.x.data(), corner[i]);
    y[i] = hn::GatherIndex(di, in.y.data(), corner[i]);
  }
  const auto before = [&](int a, int b) {
    return hn::Or(hn::Lt(y[a], y[b]), hn::And(hn::Eq(y[a], y[b]), hn::Lt(x[a], x[b])));
  };
  const auto first_is_1 = hn::And(before(1, 0), hn::Not(before(2, 1)));
  const auto first_is_2 = hn::And(before(2, 0), before(2, 1));
  const auto turn = [&](const VI32 v[3], VI32 out[3]) {
    for (int i = 0; i < 3; ++i)
      out[i] = hn::IfThenElse(first_is_2, v[(i + 2) % 3], hn::IfThenElse(first_is_1, v[(i + 1) % 3], v[i]));
  };
  Weights w;
  VI32 cx[3], cy[3];
  turn(corner, w.vertex);
  turn(x, cx);
  turn(y, cy);
  V64* const rx = w.x;
  V64* const ry = w.y;
  V64* const u = w.u;
  V64 e[3];
  for (int i = 0; i < 3; ++i) {
    rx[i] = hn::Sub(hn::PromoteTo(d, cx[i]), hn::Mul(px, hn::Set(d, 256.0)));
    ry[i] = hn::Sub(hn::PromoteTo(d, cy[i]), hn::Mul(py, hn::Set(d, 256.0)));
    u[i] = hn::GatherIndex(d, in.u.data(), hn::PromoteTo(dl, w.vertex[i]));
  }
  for (int i = 0; i < 3; ++i)
    e[i] = hn::Sub(hn::Mul(rx[(i + 1) % 3], ry[(i + 2) % 3]), hn::Mul(rx[(i + 2) % 3], ry[(i + 1) % 3]));
  w.at = barycentrics(e, u, hn::Add(hn::Add(e[0], e[1]), e[2]));
  return w;
}

/// Edge slopes of pixels whose triangles differ: exact.
HWY_INLINE void edge_slopes(const Weights& w, V64 along_x[3], V64 along_y[3]) {
  const V64 pixel = hn::Set(D64(), 256.0);
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    along_x[i] = hn::Mul(hn::Sub(w.y[a], w.y[b]), pixel);
    along_y[i] = hn::Mul(hn::Sub(w.x[b], w.x[a]), pixel);
  }
}

/// The derivatives of one coordinate whose vertex values are a0, a1, a2; 0 for a flat one.
HWY_INLINE void coordinate_slopes(const BarycentricSlopes& along_x, const BarycentricSlopes& along_y, Interpolation how,
                                  V64 a0, V64 a1, V64 a2, V64& x, V64& y) {
  x = y = hn::Zero(D64());
  if (how == Interpolation::flat) return;
  const bool smooth = how == Interpolation::smooth;
  x = affine_slope(smooth ? along_x.smooth : along_x.linear, a0, a1, a2);
  y = affine_slope(smooth ? along_y.smooth : along_y.linear, a0, a1, a2);
}

HWY_INLINE V32 interpolated(const float* stream, const Weights& w, Interpolation how, VI32 provoking) {
  const D64 d;
  const D32 df;
  if (how == Interpolation::flat) return hn::GatherIndex(df, stream, provoking);
  const V32 a0 = hn::GatherIndex(df, stream, w.vertex[0]), a1 = hn::GatherIndex(df, stream, w.vertex[1]),
            a2 = hn::GatherIndex(df, stream, w.vertex[2]);
  const V64* b = how == Interpolation::smooth ? w.at.smooth : w.at.linear;
  const V32 value = hn::DemoteTo(df, affine(b, hn::PromoteTo(d, a0), hn::PromoteTo(d, a1), hn::PromoteTo(d, a2)));
  const V32 low = lesser(lesser(a0, a1), a2), high = greater(greater(a0, a1), a2);
  return lesser(greater(value, low), high);
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
