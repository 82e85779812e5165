// depth_plane.h for vectors: a lane a triangle, or a lane a sample of one triangle. Included once per SIMD target.
#if defined(TRUESHADE_RASTER_TRIANGLES_DEPTH_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_TRIANGLES_DEPTH_PLANE_INL_H_
#undef TRUESHADE_RASTER_TRIANGLES_DEPTH_PLANE_INL_H_
#else
#define TRUESHADE_RASTER_TRIANGLES_DEPTH_PLANE_INL_H_
#endif

#include <hwy/highway.h>

#include "raster/triangles/depth_plane.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Depth planes of a vector of triangles, or one in all lanes.
struct DepthPlanes {
  V64 z0, g1, g2, low, high;

  HWY_INLINE DepthPlanes(V64 corner0, V64 corner1, V64 corner2, V64 area)
      : z0(corner0), g1(hn::Div(hn::Sub(corner1, corner0), area)), g2(hn::Div(hn::Sub(corner2, corner0), area)) {
    const auto rising = hn::Lt(corner1, corner2);
    const V64 less = hn::IfThenElse(rising, corner1, corner2), more = hn::IfThenElse(rising, corner2, corner1);
    low = hn::IfThenElse(hn::Lt(corner0, less), corner0, less);
    high = hn::IfThenElse(hn::Gt(corner0, more), corner0, more);
  }
  HWY_INLINE explicit DepthPlanes(const DepthPlane& p)
      : z0(hn::Set(D64(), p.z0)),
        g1(hn::Set(D64(), p.g1)),
        g2(hn::Set(D64(), p.g2)),
        low(hn::Set(D64(), p.low)),
        high(hn::Set(D64(), p.high)) {}
  HWY_INLINE DepthPlanes() = default;

  HWY_INLINE void clamp_to_range(double least, double most) {
    low = hn::Min(hn::Max(low, hn::Set(D64(), least)), hn::Set(D64(), most));
    high = hn::Min(hn::Max(high, hn::Set(D64(), least)), hn::Set(D64(), most));
  }

  HWY_INLINE V64 at(V64 e1, V64 e2) const {
    const V64 plane = hn::Add(z0, hn::Add(hn::Mul(e1, g1), hn::Mul(e2, g2)));
    return hn::Min(hn::Max(plane, low), high);
  }
};

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
