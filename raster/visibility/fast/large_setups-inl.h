// Sets up a cluster's triangles over many samples, a lane each, with the bits of triangle_setup.h and depth_plane.h.
// large_vectors-inl.h draws them. Included once per SIMD target. docs/arithmetic.md sections 4 and 5.
#if defined(TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_SETUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_SETUPS_INL_H_
#undef TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_SETUPS_INL_H_
#else
#define TRUESHADE_RASTER_VISIBILITY_FAST_LARGE_SETUPS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raster/triangles/depth_plane-inl.h"
#include "raster/triangles/edge_rule-inl.h"
#include "raster/visibility/fast/large_triangles-inl.h"
#include "raster/visibility/fast/small_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The setups of a vector of triangles: an array for each number, an element for each triangle.
struct LargeSetups {
  static constexpr int kMost = 16;
  alignas(64) int32_t vertex[3][kMost], x[3][kMost], y[3][kMost];  ///< corners in canonical order
  alignas(64) int32_t x0[kMost], y0[kMost], x1[kMost],
      y1[kMost];  ///< blocks that hold the samples of the box, inclusive
  /// floor((E - least) / 256) at pixel (0, 0), plus the most that it grows by over a block; to the next column, row.
  alignas(64) int32_t first[3][kMost], across[3][kMost], up[3][kMost], most[3][kMost];
  alignas(64) double c[2][kMost], sx[2][kMost], sy[2][kMost];  ///< of E_1 and E_2
  alignas(64) double z0[kMost], g1[kMost], g2[kMost], low[kMost], high[kMost];
  alignas(64) float near[kMost], near_across[kMost], near_up[kMost], nearest[kMost];  ///< NearPlane, DepthSink::nearest
  uint32_t drawn, too_long;  ///< a bit a triangle: may cover a sample; may, but is for other paths
};

/// What drawing a cluster's large triangles reads.
struct LargeDraw {
  const WindowVertices& vertices;
  const GeometryState& state;
  bool upper_left;
  const TileRect& rect;
};

/// Lanes whose first corner comes before the second in the canonical order.
HWY_INLINE hn::Mask<DT> comes_first(VT xa, VT ya, VT xb, VT yb) {
  return hn::Or(hn::Lt(ya, yb), hn::And(hn::Eq(ya, yb), hn::Lt(xa, xb)));
}

/// Corners in canonical order and the box of samples; returns the lanes where that is not empty.
HWY_INLINE hn::Mask<DT> order_corners(const LargeDraw& in, VT word, LargeSetups& out) {
  const DT d;
  const VT last_vertex = hn::Set(d, kClusterVertices - 1);
  const VT at[3] = {hn::And(word, last_vertex), hn::And(hn::ShiftRight<8>(word), last_vertex),
                    hn::And(hn::ShiftRight<16>(word), last_vertex)};
  VT x[3], y[3];
  for (int k = 0; k < 3; ++k) x[k] = corner_at(in.vertices.x, at[k]), y[k] = corner_at(in.vertices.y, at[k]);
  const auto from_2 = hn::And(comes_first(x[2], y[2], x[0], y[0]), comes_first(x[2], y[2], x[1], y[1]));
  const auto from_1 = comes_first(x[1], y[1], x[0], y[0]);
  for (int k = 0; k < 3; ++k) {
    const int one = (k + 1) % 3, two = (k + 2) % 3;
    const auto rotated = [&](const VT* v) {
      return hn::IfThenElse(from_2, v[two], hn::IfThenElse(from_1, v[one], v[k]));
    };
    hn::Store(rotated(at), d, out.vertex[k]);
    hn::Store(rotated(x), d, out.x[k]);
    hn::Store(rotated(y), d, out.y[k]);
  }
  const VT round_up = hn::Set(d, 255);
  const int* limit = in.rect.limit;
  const VT x0 = hn::Max(hn::ShiftRight<8>(hn::Add(least_of(x[0], x[1], x[2]), round_up)), hn::Set(d, limit[0]));
  const VT y0 = hn::Max(hn::ShiftRight<8>(hn::Add(least_of(y[0], y[1], y[2]), round_up)), hn::Set(d, limit[1]));
  const VT x1 = hn::Min(hn::ShiftRight<8>(most_of(x[0], x[1], x[2])), hn::Set(d, limit[2] - 1));
  const VT y1 = hn::Min(hn::ShiftRight<8>(most_of(y[0], y[1], y[2])), hn::Set(d, limit[3] - 1));
  hn::Store(hn::ShiftRight<2>(x0), d, out.x0);
  hn::Store(hn::ShiftRight<2>(y0), d, out.y0);
  hn::Store(hn::ShiftRight<2>(x1), d, out.x1);
  hn::Store(hn::ShiftRight<2>(y1), d, out.y1);
  return hn::Not(hn::Or(hn::Gt(x0, x1), hn::Gt(y0, y1)));
}

/// The near plane of the triangles [i, i + lanes): NearPlane for vectors.
HWY_INLINE void set_near_planes(const DepthPlanes& plane, const V64 c[3], const V64 sx[3], const V64 sy[3], int i,
                                LargeSetups& out) {
  const D64 d;
  const V64 z0 = plane.z0, g1 = plane.g1, g2 = plane.g2;
  const D32 df;
  const V64 zx = hn::Add(hn::Mul(sx[1], g1), hn::Mul(sx[2], g2)), zy = hn::Add(hn::Mul(sy[1], g1), hn::Mul(sy[2], g2));
  const V64 z1 = hn::Mul(c[1], g1), z2 = hn::Mul(c[2], g2), zero = hn::Zero(d);
  const V64 falls = hn::Mul(hn::Set(d, 3.0), hn::Add(hn::Min(zx, zero), hn::Min(zy, zero)));
  const V64 least = hn::Add(hn::Add(z0, hn::Add(z1, z2)), falls);
  const V64 terms = hn::Add(hn::Add(hn::Abs(z0), hn::Add(hn::Abs(z1), hn::Abs(z2))),
                            hn::Mul(hn::Set(d, 64.0), hn::Add(hn::Abs(zx), hn::Abs(zy))));
  const auto bounded = hn::Lt(terms, hn::Set(d, 0x1p100));
  const V64 slack = hn::Mul(terms, hn::Set(d, 0x1p-20)), unknown = hn::Set(d, -0x1p100);
  hn::Store(hn::DemoteTo(df, hn::IfThenElse(bounded, hn::Sub(least, slack), unknown)), df, out.near + i);
  const V64 block = hn::Set(d, double(kBlockSize));
  hn::Store(hn::DemoteTo(df, hn::IfThenElseZero(bounded, hn::Mul(block, zx))), df, out.near_across + i);
  hn::Store(hn::DemoteTo(df, hn::IfThenElseZero(bounded, hn::Mul(block, zy))), df, out.near_up + i);
}

/// Edge functions and depth planes of the triangles [i, i + lanes), and the bits of those with an area that culling
/// leaves and of those too long for WholeEdges.
HWY_INLINE void set_up_lanes(const LargeDraw& in, const DepthSink& sink, int i, LargeSetups& out) {
  const D64 d;
  const D32 df;
  const I32 di;
  const hn::RebindToSigned<D64> d_at;
  using Whole = WholeEdges<double>;
  const V64 zero = hn::Zero(d), one = hn::Set(d, 1.0);
  V64 x[3], y[3], z[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = hn::PromoteTo(d, hn::Load(di, out.x[k] + i));
    y[k] = hn::PromoteTo(d, hn::Load(di, out.y[k] + i));
    z[k] = hn::GatherIndex(d, in.vertices.z, hn::PromoteTo(d_at, hn::Load(di, out.vertex[k] + i)));
  }
  const V64 area =
      hn::Sub(hn::Mul(hn::Sub(x[1], x[0]), hn::Sub(y[2], y[0])), hn::Mul(hn::Sub(x[2], x[0]), hn::Sub(y[1], y[0])));
  auto face = hn::Ne(area, zero);
  if (culled(in.state, !in.upper_left)) face = hn::And(face, hn::Lt(area, zero));
  if (culled(in.state, in.upper_left)) face = hn::And(face, hn::Gt(area, zero));
  const V64 sign = hn::And(area, hn::Set(d, -0.0)), size = hn::Abs(area);
  DepthPlanes plane(z[0], z[1], z[2], size);

  V64 c[3], sx[3], sy[3];
  auto fits = hn::Eq(zero, zero);
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const V64 dx = hn::Sub(x[b], x[a]), dy = hn::Sub(y[b], y[a]);
    c[k] = hn::Xor(hn::Sub(hn::Mul(dy, x[a]), hn::Mul(dx, y[a])), sign);
    const V64 down = hn::Xor(dy, sign), across = hn::Neg(down), up = hn::Xor(dx, sign);
    sx[k] = hn::Mul(across, hn::Set(d, 256.0)), sy[k] = hn::Mul(up, hn::Set(d, 256.0));
    const auto owns = owned_edges(up, down, in.upper_left);
    const V64 first = hn::Floor(hn::Mul(hn::Sub(c[k], hn::IfThenZeroElse(owns, one)), hn::Set(d, 0x1p-8)));
    const V64 most = hn::Mul(hn::Set(d, 3.0), hn::Add(hn::Max(across, zero), hn::Max(up, zero)));
    const V64 clamped = hn::Min(hn::Max(first, hn::Set(d, -double(Whole::kMost))), hn::Set(d, double(Whole::kMost)));
    hn::Store(hn::DemoteTo(di, hn::Add(clamped, most)), di, out.first[k] + i);
    hn::Store(hn::DemoteTo(di, most), di, out.most[k] + i);
    hn::Store(hn::DemoteTo(di, across), di, out.across[k] + i);
    hn::Store(hn::DemoteTo(di, up), di, out.up[k] + i);
    fits = hn::And(fits, hn::Le(hn::Add(hn::Abs(across), hn::Abs(up)), hn::Set(d, double(Whole::kMostSlope))));
  }
  for (int k = 0; k < 2; ++k) {
    hn::Store(c[k + 1], d, out.c[k] + i);
    hn::Store(sx[k + 1], d, out.sx[k] + i);
    hn::Store(sy[k + 1], d, out.sy[k] + i);
  }
  plane.clamp_to_range(double(sink.range_low), double(sink.range_high));
  hn::Store(plane.z0, d, out.z0 + i);
  hn::Store(plane.g1, d, out.g1 + i);
  hn::Store(plane.g2, d, out.g2 + i);
  hn::Store(plane.low, d, out.low + i);
  hn::Store(plane.high, d, out.high + i);
  hn::Store(sink.stored(hn::DemoteTo(df, plane.low)), df, out.nearest + i);
  set_near_planes(plane, c, sx, sy, i, out);
  out.drawn |= lane_bits(d, hn::And(face, fits)) << i;
  out.too_long |= lane_bits(d, hn::AndNot(fits, face)) << i;
}

/// The first `count` words of a list, or a vector of them.
HWY_INLINE void set_up_large(const LargeDraw& in, const int32_t* list, int count, const DepthSink& sink,
                             LargeSetups& out) {
  const DT d;
  const VT word = hn::Load(d, list);
  const auto present = hn::FirstN(d, size_t(count));
  const uint32_t sampled = lane_bits(d, hn::And(present, order_corners(in, word, out)));
  out.drawn = out.too_long = 0;
  for (int i = 0; i < std::min(count, int(hn::Lanes(d))); i += int(hn::Lanes(D64()))) set_up_lanes(in, sink, i, out);
  out.drawn &= sampled, out.too_long &= sampled;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
