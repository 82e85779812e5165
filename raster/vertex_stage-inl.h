// The vertex stage for vectors of a cluster's vertices: clip position, outcodes, snapped window position, depth.
// Included once per SIMD target. docs/arithmetic.md sections 2 to 5.
#if defined(TRUESHADE_RASTER_VERTEX_STAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_VERTEX_STAGE_INL_H_
#undef TRUESHADE_RASTER_VERTEX_STAGE_INL_H_
#else
#define TRUESHADE_RASTER_VERTEX_STAGE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/clusters.h"
#include "raster/fixed_point.h"
#include "raster/snap.h"
#include "raster/view.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;  // a lane is a vertex, a triangle or a pixel; lanes never meet
using D32 = hn::Rebind<float, D64>;   // as many floats
using I32 = hn::Rebind<int32_t, D64>;
using U32 = hn::Rebind<uint32_t, D64>;
using V64 = hn::Vec<D64>;
using V32 = hn::Vec<D32>;

/// Row `m` of an affine transform: ((m0 x + m1 y) + m2 z) + m3.
template <class V>
HWY_INLINE V affine_row(const float m[4], V x, V y, V z) {
  const hn::DFromV<V> d;
  return hn::Add(
      hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)), hn::Mul(hn::Set(d, m[2]), z)),
      hn::Set(d, m[3]));
}

/// Vertices in window space, relative to the sample of a tile's pixel (0, 0). Where `needs_care` is set, x and y mean
/// nothing: the vertex is outside near or far, has w <= 0 or no finite value, or lies 2^25 subpixels away; clip.h sees
/// to its triangles.
struct WindowVertices {
  alignas(64) int32_t x[kClusterVertices], y[kClusterVertices];  ///< 1/256 pixel, y up, |.| < 2^26
  alignas(64) double z[kClusterVertices];                        ///< window depth
  alignas(64) double u[kClusterVertices];                        ///< 1 / w
  alignas(64) int32_t needs_care[kClusterVertices];              ///< -1 or 0
  bool any_needs_care;
};

/// Window position of the sample of a tile's pixel (0, 0), in 1/256 pixel.
struct SampleOrigin {
  int32_t x, y;
};
inline SampleOrigin sample_origin(int tile_x, int tile_y) { return {tile_x * 256 + 128, tile_y * 256 + 128}; }

/// Where the quotient lies too close to a tie for its f64 estimate, the exact one decides.
HWY_INLINE V64 round_near_ties(V64 estimate, V64 rounded, V64 coordinate, V64 w, int64_t scale) {
  const D64 d;
  const auto close = hn::Gt(hn::Abs(hn::Sub(estimate, rounded)), hn::Set(d, 0.5 - 0x1p-14));
  if (HWY_LIKELY(hn::AllFalse(d, close))) return rounded;
  constexpr size_t kLanes = HWY_MAX_BYTES / sizeof(double);
  alignas(64) double c[kLanes], ws[kLanes], r[kLanes], e[kLanes];
  hn::Store(coordinate, d, c);
  hn::Store(w, d, ws);
  hn::Store(rounded, d, r);
  hn::Store(estimate, d, e);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    if (!(e[i] < 2.0 * double(kVectorLimit) && e[i] > -2.0 * double(kVectorLimit)) || !(ws[i] > 0.0)) continue;
    const std::optional<int64_t> exact = snapped_quotient(c[i], ws[i], scale);
    if (exact) r[i] = double(*exact);
  }
  return hn::Load(d, r);
}

/// fl32(a * b + c), rounded once; snap.cpp says how.
HWY_INLINE V32 fused_multiply_add(V32 a, V32 b, V32 c) {
  const D64 d;
  const D32 df;
  const hn::RebindToSigned<D64> di;
  const V64 product = hn::Mul(hn::PromoteTo(d, a), hn::PromoteTo(d, b)), wide_c = hn::PromoteTo(d, c);
  const V64 sum = hn::Add(product, wide_c), c_part = hn::Sub(sum, product);
  const V64 error = hn::Add(hn::Sub(product, hn::Sub(sum, c_part)), hn::Sub(wide_c, c_part)), zero = hn::Zero(d);
  const auto bits = hn::BitCast(di, sum), one = hn::Set(di, 1);
  const auto larger =
      hn::Gt(hn::Mul(hn::IfThenElse(hn::Gt(error, zero), hn::Set(d, 1.0), hn::Set(d, -1.0)), sum), zero);
  const auto odd = hn::IfThenElse(hn::RebindMask(di, larger), hn::Add(bits, one), hn::Sub(bits, one));
  const auto moves = hn::And(hn::RebindMask(di, hn::Or(hn::Lt(error, zero), hn::Gt(error, zero))),
                             hn::Eq(hn::And(bits, one), hn::Zero(di)));
  return hn::DemoteTo(df, hn::BitCast(d, hn::IfThenElse(moves, odd, bits)));
}

/// Window coordinate in 1/256 pixel as llvmpipe 22.3 rounds it: float_snapped() for vectors.
HWY_INLINE V64 float_snap(V64 coordinate, V64 w, const WindowTransform& t, int axis) {
  const D64 d;
  const D32 df;
  const V32 ndc = hn::Mul(hn::DemoteTo(df, coordinate), hn::Div(hn::Set(df, 1.0f), hn::DemoteTo(df, w)));
  const V32 pixels = fused_multiply_add(ndc, hn::Set(df, t.half_size[axis]), hn::Set(df, t.center[axis]));
  const V32 from_center = hn::Mul(hn::Sub(pixels, hn::Set(df, 0.5f)), hn::Set(df, 256.0f));
  return hn::Add(hn::Round(hn::PromoteTo(d, from_center)), hn::Set(d, 128.0));
}

/// One axis of the window position, relative to `origin`; `fits` loses the lanes that do not fit the vector path.
template <class M>
HWY_INLINE hn::Vec<I32> snap_axis(V64 coordinate, V64 w, V64 u, const WindowTransform& t, int axis, int32_t origin,
                                  M& fits) {
  const D64 d;
  const V64 estimate = hn::Mul(hn::Mul(coordinate, u), hn::Set(d, double(t.scale[axis])));
  V64 window;
  if (t.float_snap) {
    window = float_snap(coordinate, w, t, axis);
  } else {
    const V64 rounded = round_near_ties(estimate, hn::Round(estimate), coordinate, w, t.scale[axis]);
    window = hn::Add(rounded, hn::Set(d, double(t.offset[axis])));
  }
  const V64 limit = hn::Set(d, double(kVectorLimit));
  // The estimate is bounded too: a far-away viewport must not bring a badly rounded quotient back into range.
  const auto small = hn::And(hn::Lt(hn::Abs(window), limit), hn::Lt(hn::Abs(estimate), hn::Add(limit, limit)));
  fits = hn::And(fits, small);
  return hn::DemoteTo(I32(), hn::IfThenElseZero(small, hn::Sub(window, hn::Set(d, double(origin)))));
}

/// Places one vector of clip positions at out[i...]; returns whether any of them needs care.
HWY_INLINE bool place_vertices(V32 cx, V32 cy, V32 cz, V32 cw, const WindowTransform& t, SampleOrigin origin, size_t i,
                               WindowVertices& out) {
  const D64 d;
  const I32 di;
  const V64 wx = hn::PromoteTo(d, cx), wy = hn::PromoteTo(d, cy), wz = hn::PromoteTo(d, cz), ww = hn::PromoteTo(d, cw);
  auto fits = hn::Ge(ww, hn::Set(d, 0x1p-100));
  if (!t.depth_clamp) {
    const V64 near = t.zero_to_one ? hn::Zero(d) : hn::Neg(ww);
    fits = hn::And(fits, hn::And(hn::Ge(wz, near), hn::Le(wz, ww)));
  }
  // Inf - Inf is NaN: only where all four are finite is the sum of the differences zero.
  const V64 nothing = hn::Add(hn::Add(hn::Sub(wx, wx), hn::Sub(wy, wy)), hn::Add(hn::Sub(wz, wz), hn::Sub(ww, ww)));
  fits = hn::And(fits, hn::Eq(nothing, hn::Zero(d)));
  const V64 u = hn::Div(hn::Set(d, 1.0), ww);
  hn::Store(snap_axis(wx, ww, u, t, 0, origin.x, fits), di, out.x + i);
  hn::Store(snap_axis(wy, ww, u, t, 1, origin.y, fits), di, out.y + i);
  hn::Store(u, d, out.u + i);
  hn::Store(hn::Add(hn::Mul(hn::Mul(wz, u), hn::Set(d, t.z_scale)), hn::Set(d, t.z_offset)), d, out.z + i);
  hn::Store(hn::DemoteTo(di, hn::IfThenElse(fits, hn::Zero(d), hn::Set(d, -1.0))), di, out.needs_care + i);
  return !hn::AllTrue(d, fits);
}

/// The same for vertices known to need no care (ClusterDraw::plain), snapped as the profile `ideal` says. Holds what an
/// instance's vertices share: stores of theirs might change what is read through references, so it would be read anew.
class PlainVertices {
 public:
  HWY_INLINE PlainVertices(const InstanceTransform& instance, const WindowTransform& t, SampleOrigin origin)
      : snap_scale_{t.scale[0], t.scale[1]},
        scale_{double(t.scale[0]), double(t.scale[1])},
        offset_{double(t.offset[0] - origin.x), double(t.offset[1] - origin.y)},
        z_scale_(t.z_scale),
        z_offset_(t.z_offset) {
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) clip_[r][c] = instance.clip[r][c];
  }

  /// Places one vector of object-space positions at out[i...]; with their depths or without.
  template <bool kDepth = true>
  HWY_INLINE void place(V32 px, V32 py, V32 pz, size_t i, WindowVertices& out) const {
    place_clip<kDepth>(affine_row(clip_[0], px, py, pz), affine_row(clip_[1], px, py, pz),
                       kDepth ? affine_row(clip_[2], px, py, pz) : px, affine_row(clip_[3], px, py, pz), i, out);
  }

  /// The same for vectors of twice as many, whose sums fill a vector then.
  HWY_INLINE void place_two(const float* x, const float* y, const float* z, size_t i, WindowVertices& out) const {
    const hn::ScalableTag<float> d;
    const auto px = hn::LoadU(d, x + i), py = hn::LoadU(d, y + i), pz = hn::LoadU(d, z + i);
    hn::Vec<decltype(d)> clip[4];
    for (int r = 0; r < 4; ++r) clip[r] = affine_row(clip_[r], px, py, pz);
#if HWY_TARGET == HWY_SCALAR
    place_clip<true>(clip[0], clip[1], clip[2], clip[3], i, out);
#else
    const D32 half;
    place_clip<true>(hn::LowerHalf(half, clip[0]), hn::LowerHalf(half, clip[1]), hn::LowerHalf(half, clip[2]),
                     hn::LowerHalf(half, clip[3]), i, out);
    place_clip<true>(hn::UpperHalf(half, clip[0]), hn::UpperHalf(half, clip[1]), hn::UpperHalf(half, clip[2]),
                     hn::UpperHalf(half, clip[3]), i + hn::Lanes(half), out);
#endif
  }

 private:
  template <bool kDepth>
  HWY_INLINE void place_clip(V32 cx, V32 cy, [[maybe_unused]] V32 cz, V32 cw, size_t i, WindowVertices& out) const {
    const D64 d;
    const I32 di;
    const V64 wx = hn::PromoteTo(d, cx), wy = hn::PromoteTo(d, cy), ww = hn::PromoteTo(d, cw);
    const V64 u = hn::Div(hn::Set(d, 1.0), ww);
    const V64 x = hn::Mul(hn::Mul(wx, u), hn::Set(d, scale_[0])), y = hn::Mul(hn::Mul(wy, u), hn::Set(d, scale_[1]));
    V64 x_fx = hn::Round(x), y_fx = hn::Round(y);
    const V64 off = hn::Max(hn::Abs(hn::Sub(x, x_fx)), hn::Abs(hn::Sub(y, y_fx)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::Gt(off, hn::Set(d, 0.5 - 0x1p-14))))) {
      x_fx = round_near_ties(x, x_fx, wx, ww, snap_scale_[0]);
      y_fx = round_near_ties(y, y_fx, wy, ww, snap_scale_[1]);
    }
    hn::Store(hn::DemoteTo(di, hn::Add(x_fx, hn::Set(d, offset_[0]))), di, out.x + i);
    hn::Store(hn::DemoteTo(di, hn::Add(y_fx, hn::Set(d, offset_[1]))), di, out.y + i);
    hn::Store(u, d, out.u + i);
    if constexpr (kDepth) {
      const V64 wz = hn::PromoteTo(d, cz);
      hn::Store(hn::Add(hn::Mul(hn::Mul(wz, u), hn::Set(d, z_scale_)), hn::Set(d, z_offset_)), d, out.z + i);
    }
  }

  float clip_[4][4];
  int64_t snap_scale_[2];
  double scale_[2], offset_[2], z_scale_, z_offset_;
};

/// Window positions of all vertices of a cluster. `plain`: none of them needs care, by its bounds.
inline void window_vertices(const ClusteredMesh& mesh, const Cluster& cluster, const InstanceTransform& instance,
                            const WindowTransform& t, SampleOrigin origin, bool plain, WindowVertices& out) {
  const D32 df;
  out.any_needs_care = false;
  const float* position[3];
  for (size_t c = 0; c < 3; ++c) position[c] = mesh.position[c].data() + cluster.first_vertex;
  const auto at = [&](size_t axis, size_t i) { return hn::LoadU(df, position[axis] + i); };
  if (plain) {
    const PlainVertices vertices(instance, t, origin);
    for (size_t i = 0; i < cluster.vertices; i += hn::Lanes(hn::ScalableTag<float>()))
      vertices.place_two(position[0], position[1], position[2], i, out);
    return;
  }
  for (size_t i = 0; i < cluster.vertices; i += hn::Lanes(df)) {
    V32 clip[4];
    for (int r = 0; r < 4; ++r) clip[r] = affine_row(instance.clip[r], at(0, i), at(1, i), at(2, i));
    const bool care = place_vertices(clip[0], clip[1], clip[2], clip[3], t, origin, i, out);
    out.any_needs_care = out.any_needs_care || care;
  }
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
