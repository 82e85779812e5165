// The vertex stage for vectors of a cluster's vertices: clip position, outcodes, snapped window position, depth.
// Included once per SIMD target. docs/arithmetic.md sections 2 to 5.
#if defined(TRUESHADE_RASTER_TRIANGLES_VERTEX_STAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLES_VERTEX_STAGE_INL_H_
#undef TRUESHADE_RASTER_TRIANGLES_VERTEX_STAGE_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLES_VERTEX_STAGE_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "core/simd/lanes-inl.h"
#include "raster/clusters/clusters.h"
#include "raster/fixed_point.h"
#include "raster/triangles/snap.h"
#include "raster/view.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Row `m` of an affine transform: ((m0 x + m1 y) + m2 z) + m3.
template <class V>
HWY_INLINE V affine_row(const float m[4], V x, V y, V z) {
  const hn::DFromV<V> d;
  return hn::Add(
      hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)), hn::Mul(hn::Set(d, m[2]), z)),
      hn::Set(d, m[3]));
}

/// Box of a cluster's vertices or of a triangle's, from the snapped coordinates, and its least depth.
struct WindowBox {
  int32_t x0, y0, x1, y1;
  double near;
};

/// A WindowBox in the making: each lane has the bounds of every n-th vertex, n being the number of lanes.
class VertexBox {
 public:
  HWY_INLINE VertexBox()
      : x0_(hn::Set(I32(), std::numeric_limits<int32_t>::max())),
        y0_(x0_),
        x1_(hn::Set(I32(), std::numeric_limits<int32_t>::lowest())),
        y1_(x1_),
        near_(hn::Set(D64(), std::numeric_limits<double>::infinity())) {}
  HWY_INLINE void add(hn::Vec<I32> x, hn::Vec<I32> y, V64 z) {
    x0_ = hn::Min(x0_, x);
    x1_ = hn::Max(x1_, x);
    y0_ = hn::Min(y0_, y);
    y1_ = hn::Max(y1_, y);
    near_ = hn::Min(near_, z);
  }
  HWY_INLINE WindowBox box() const {
    const I32 d;
    return {hn::GetLane(hn::MinOfLanes(d, x0_)), hn::GetLane(hn::MinOfLanes(d, y0_)),
            hn::GetLane(hn::MaxOfLanes(d, x1_)), hn::GetLane(hn::MaxOfLanes(d, y1_)),
            hn::GetLane(hn::MinOfLanes(D64(), near_))};
  }

 private:
  hn::Vec<I32> x0_, y0_, x1_, y1_;
  V64 near_;
};

/// Vertices in window space, relative to the sample of a tile's pixel (0, 0). Where `needs_clip` is set, x and y mean
/// nothing: the vertex is outside near or far, has w <= 0 or no finite value, or lies 2^25 subpixels away; clip.h sees
/// to its triangles.
struct WindowVertices {
  alignas(64) int32_t x[kClusterVertices], y[kClusterVertices];  ///< 1/256 pixel, y up, |.| < 2^26
  alignas(64) double z[kClusterVertices];                        ///< window depth
  alignas(64) double u[kClusterVertices];                        ///< 1 / w
  alignas(64) int32_t needs_clip[kClusterVertices];              ///< -1 or 0
  bool any_needs_clip;
  WindowBox box;  ///< of all, where none needs clipping
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
  return hn::Add(hn::Round(hn::PromoteTo(d, from_center)), hn::Set(d, double(128 - 256 * t.corner[axis])));
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

/// Places one vector of clip positions at out[i...]; returns whether any of them needs clipping.
HWY_INLINE bool project_vertices(V32 cx, V32 cy, V32 cz, V32 cw, const WindowTransform& t, SampleOrigin origin,
                                 size_t i, WindowVertices& out) {
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
  hn::Store(hn::DemoteTo(di, hn::IfThenElse(fits, hn::Zero(d), hn::Set(d, -1.0))), di, out.needs_clip + i);
  return !hn::AllTrue(d, fits);
}

/// The same for vertices known to need no clipping (ClusterDraw::no_clip), snapped as the profile `ideal` says. Holds
/// what an instance's vertices share: stores of theirs might change what is read through references, so it would be
/// read anew.
class UnclippedVertices {
 public:
  HWY_INLINE UnclippedVertices(const InstanceTransform& instance, const WindowTransform& t, SampleOrigin origin)
      : snap_scale_{t.scale[0], t.scale[1]},
        scale_{double(t.scale[0]), double(t.scale[1])},
        shift_{kWhole + double(t.offset[0] - origin.x), kWhole + double(t.offset[1] - origin.y)},
        z_scale_(t.z_scale),
        z_offset_(t.z_offset) {
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) clip_[r][c] = instance.clip[r][c];
  }

  /// Places one vector of object-space positions at out[i...].
  HWY_INLINE void place(V32 px, V32 py, V32 pz, size_t i, WindowVertices& out) const {
    place_clip(affine_row(clip_[0], px, py, pz), affine_row(clip_[1], px, py, pz), affine_row(clip_[3], px, py, pz), i,
               out);
  }

  /// The same for vectors of twice as many, whose sums fill a vector then, with their depths.
  HWY_INLINE void project_two(const float* x, const float* y, const float* z, size_t i, WindowVertices& out,
                              VertexBox& box) const {
    const hn::ScalableTag<float> d;
    const auto px = hn::LoadU(d, x + i), py = hn::LoadU(d, y + i), pz = hn::LoadU(d, z + i);
    hn::Vec<decltype(d)> clip[4];
    for (int r = 0; r < 4; ++r) clip[r] = affine_row(clip_[r], px, py, pz);
#if HWY_TARGET == HWY_SCALAR
    place_with_depth(clip[0], clip[1], clip[2], clip[3], i, out, box);
#else
    const D32 half;
    place_with_depth(hn::LowerHalf(half, clip[0]), hn::LowerHalf(half, clip[1]), hn::LowerHalf(half, clip[2]),
                     hn::LowerHalf(half, clip[3]), i, out, box);
    place_with_depth(hn::UpperHalf(half, clip[0]), hn::UpperHalf(half, clip[1]), hn::UpperHalf(half, clip[2]),
                     hn::UpperHalf(half, clip[3]), i + hn::Lanes(half), out, box);
#endif
  }

 private:
  struct Placed {
    hn::Vec<I32> x, y;
    V64 u;
  };

  HWY_INLINE void place_with_depth(V32 cx, V32 cy, V32 cz, V32 cw, size_t i, WindowVertices& out,
                                   VertexBox& box) const {
    const D64 d;
    const Placed p = place_clip(cx, cy, cw, i, out);
    const V64 z = hn::Add(hn::Mul(hn::Mul(hn::PromoteTo(d, cz), p.u), hn::Set(d, z_scale_)), hn::Set(d, z_offset_));
    hn::Store(z, d, out.z + i);
    box.add(p.x, p.y, z);
  }

  HWY_INLINE Placed place_clip(V32 cx, V32 cy, V32 cw, size_t i, WindowVertices& out) const {
    const D64 d;
    const I32 di;
    const V64 wx = hn::PromoteTo(d, cx), wy = hn::PromoteTo(d, cy), ww = hn::PromoteTo(d, cw);
    const V64 u = hn::Div(hn::Set(d, 1.0), ww), x_shift = hn::Set(d, shift_[0]), y_shift = hn::Set(d, shift_[1]);
    const V64 x = hn::Mul(hn::Mul(wx, u), hn::Set(d, scale_[0])), y = hn::Mul(hn::Mul(wy, u), hn::Set(d, scale_[1]));
    V64 x_sum = hn::Add(x, x_shift), y_sum = hn::Add(y, y_shift);
    const V64 x_fx = hn::Sub(x_sum, x_shift), y_fx = hn::Sub(y_sum, y_shift);
    const V64 off = hn::Max(hn::Abs(hn::Sub(x, x_fx)), hn::Abs(hn::Sub(y, y_fx)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::Gt(off, hn::Set(d, 0.5 - 0x1p-14))))) {
      x_sum = hn::Add(round_near_ties(x, x_fx, wx, ww, snap_scale_[0]), x_shift);
      y_sum = hn::Add(round_near_ties(y, y_fx, wy, ww, snap_scale_[1]), y_shift);
    }
    const Placed p{lower_words(x_sum), lower_words(y_sum), u};
    hn::Store(p.x, di, out.x + i);
    hn::Store(p.y, di, out.y + i);
    hn::Store(u, d, out.u + i);
    return p;
  }

  static HWY_INLINE hn::Vec<I32> lower_words(V64 v) {
    return hn::BitCast(I32(), hn::TruncateTo(U32(), hn::BitCast(hn::RebindToUnsigned<D64>(), v)));
  }

  // Doubles from 2^52 on are whole: a sum with this is rounded, and its lower word is what was added to it.
  static constexpr double kWhole = 0x1.8p52;
  float clip_[4][4];
  int64_t snap_scale_[2];
  double scale_[2], shift_[2], z_scale_, z_offset_;
};

/// Window positions of all vertices of a cluster. `no_clip`: its bounds say that none of them needs clipping.
inline void window_vertices(const ClusteredMesh& mesh, const Cluster& cluster, const InstanceTransform& instance,
                            const WindowTransform& t, SampleOrigin origin, bool no_clip, WindowVertices& out) {
  const D32 df;
  const I32 di;
  VertexBox box;
  out.any_needs_clip = false;
  const float* position[3];
  for (size_t c = 0; c < 3; ++c) position[c] = mesh.position[c].data() + cluster.first_vertex;
  const auto at = [&](size_t axis, size_t i) { return hn::LoadU(df, position[axis] + i); };
  if (no_clip) {
    const UnclippedVertices vertices(instance, t, origin);
    for (size_t i = 0; i < cluster.vertices; i += hn::Lanes(hn::ScalableTag<float>()))
      vertices.project_two(position[0], position[1], position[2], i, out, box);
    out.box = box.box();
    return;
  }
  for (size_t i = 0; i < cluster.vertices; i += hn::Lanes(df)) {
    V32 clip[4];
    for (int r = 0; r < 4; ++r) clip[r] = affine_row(instance.clip[r], at(0, i), at(1, i), at(2, i));
    const bool outside = project_vertices(clip[0], clip[1], clip[2], clip[3], t, origin, i, out);
    out.any_needs_clip = out.any_needs_clip || outside;
    box.add(hn::Load(di, out.x + i), hn::Load(di, out.y + i), hn::Load(D64(), out.z + i));
  }
  out.box = box.box();
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
