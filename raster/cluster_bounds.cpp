#include "raster/cluster_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/cluster_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <limits>

#include "raster/lanes-inl.h"
#include "raster/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Interval arithmetic on clip coordinates, a lane a cluster: what a cluster's box can reach. A float row of four
// products and three sums is off by less than 2^-21 of the sum of its terms' magnitudes.
struct Intervals {
  V64 low, high;
};

HWY_INLINE Intervals row_intervals(const float row[4], const V64 center[3], const V64 half[3]) {
  const D64 d;
  V64 middle = hn::Set(d, double(row[3])), reach = hn::Zero(d), magnitude = hn::Set(d, std::abs(double(row[3])));
  for (int i = 0; i < 3; ++i) {
    const V64 m = hn::Set(d, double(row[i])), abs_m = hn::Set(d, std::abs(double(row[i])));
    const V64 extent = hn::Mul(abs_m, half[i]);
    middle = hn::Add(middle, hn::Mul(m, center[i]));
    reach = hn::Add(reach, extent);
    magnitude = hn::Add(magnitude, hn::Add(hn::Mul(abs_m, hn::Abs(center[i])), extent));
  }
  const V64 slack = hn::Add(hn::Mul(magnitude, hn::Set(d, 0x1p-20)), hn::Set(d, 0x1p-120));
  const V64 widest = hn::Add(reach, slack);
  return {hn::Sub(middle, widest), hn::Add(middle, widest)};
}

HWY_INLINE Intervals quotients(const Intervals& a, const Intervals& w) {  // w.low > 0
  const V64 zero = hn::Zero(D64());
  return {hn::Div(a.low, hn::IfThenElse(hn::Lt(a.low, zero), w.low, w.high)),
          hn::Div(a.high, hn::IfThenElse(hn::Lt(a.high, zero), w.high, w.low))};
}

// Pixels [first, last] that intervals of normalized device coordinates can cover, one more on either side. Returns the
// lanes that have any.
HWY_INLINE M64 pixel_spans(const Intervals& ndc, const WindowTransform& t, int axis, int low, int high, int32_t* first,
                           int32_t* last) {
  const D64 d;
  const I32 di;
  const V64 scale = hn::Set(d, double(t.scale[axis]) / 256.0), offset = hn::Set(d, double(t.offset[axis]) / 256.0);
  const V64 one = hn::Set(d, 1.0), least = hn::Set(d, double(low)), most = hn::Set(d, double(high - 1));
  const V64 a = hn::Add(hn::Mul(ndc.low, scale), offset), b = hn::Add(hn::Mul(ndc.high, scale), offset);
  const V64 from = hn::Sub(hn::Min(a, b), one), to = hn::Add(hn::Max(a, b), one);
  const M64 touches = hn::And(hn::Ge(to, least), hn::Le(from, hn::Add(most, one)));
  const auto x0 = hn::DemoteTo(di, hn::Min(hn::Max(from, least), most));
  const auto x1 = hn::DemoteTo(di, hn::Min(hn::Max(to, least), most));
  hn::Store(x0, di, first);
  hn::Store(x1, di, last);
  return touches;
}

// Bounds of a vector of clusters.
struct Bounds {
  static constexpr int kMost = HWY_MAX_BYTES / sizeof(double);
  alignas(64) int32_t x0[kMost], y0[kMost], x1[kMost], y1[kMost];
  alignas(64) float near[kMost];
  uint32_t seen, unknown, plain;  // a bit a lane: may be seen; somewhere in the viewport; needs no care

  HWY_INLINE void set(const ClusterBoxes& boxes, const InstanceTransform& instance, const WindowTransform& t,
                      size_t i) {
    const D64 d;
    const D32 df;
    V64 center[3], half[3];
    for (size_t c = 0; c < 3; ++c) {
      center[c] = hn::PromoteTo(d, hn::LoadU(df, boxes.center[c].data() + i));
      half[c] = hn::PromoteTo(d, hn::LoadU(df, boxes.half_size[c].data() + i));
    }
    const Intervals x = row_intervals(instance.clip[0], center, half),
                    y = row_intervals(instance.clip[1], center, half),
                    z = row_intervals(instance.clip[2], center, half),
                    w = row_intervals(instance.clip[3], center, half);
    const V64 zero = hn::Zero(d);
    const V64 nothing = hn::Add(hn::Add(difference(x), difference(y)), hn::Add(difference(z), difference(w)));
    const M64 finite = hn::Eq(nothing, zero);
    M64 gone = hn::Le(w.high, zero), clipped = hn::Le(w.low, zero);
    if (!t.depth_clamp) {
      gone = hn::Or(gone, hn::Or(hn::Lt(z.high, t.zero_to_one ? zero : hn::Neg(w.high)), hn::Gt(z.low, w.high)));
      clipped = hn::Or(clipped, hn::Lt(z.low, t.zero_to_one ? zero : hn::Neg(w.low)));
    }
    const Intervals nx = quotients(x, w), ny = quotients(y, w), depth = quotients(z, w);
    const M64 across = pixel_spans(nx, t, 0, t.x0, t.x1, x0, x1), up = pixel_spans(ny, t, 1, t.y0, t.y1, y0, y1);
    const uint32_t somewhere = lane_bits(d, hn::Or(hn::Not(finite), hn::AndNot(gone, clipped)));
    const uint32_t here = lane_bits(d, hn::And(hn::And(finite, hn::Not(gone)), hn::And(across, up)));
    seen = somewhere | here;
    unknown = somewhere;
    const V64 scale = hn::Set(d, t.z_scale);
    const V64 nearest = hn::Add(hn::Min(hn::Mul(depth.low, scale), hn::Mul(depth.high, scale)), hn::Set(d, t.z_offset));
    const V64 slack = hn::Add(hn::Mul(hn::Abs(nearest), hn::Set(d, 0x1p-20)), hn::Set(d, 0x1p-24));
    hn::Store(hn::DemoteTo(df, hn::Sub(nearest, slack)), df, near);
    plain = lane_bits(d, without_care(nx, ny, z, w, t)) & ~somewhere;
  }

 private:
  static HWY_INLINE V64 difference(const Intervals& a) {  // not 0 where an end is infinite or NaN
    const V64 sum = hn::Add(a.low, a.high);
    return hn::Sub(sum, sum);
  }

  // Boxes in front of the near plane that lie wholly where place_vertices() finds nothing that needs care.
  static HWY_INLINE M64 without_care(const Intervals& nx, const Intervals& ny, const Intervals& z, const Intervals& w,
                                     const WindowTransform& t) {
    const D64 d;
    M64 in = hn::Ge(w.low, hn::Set(d, t.float_snap ? std::numeric_limits<double>::infinity() : 0x1p-100));
    if (!t.depth_clamp) in = hn::And(in, hn::Le(z.high, w.low));
    const Intervals* ndc[2] = {&nx, &ny};
    for (int axis = 0; axis < 2; ++axis) {
      const V64 far = hn::Max(hn::Abs(ndc[axis]->low), hn::Abs(ndc[axis]->high));
      const V64 scale = hn::Set(d, std::abs(double(t.scale[axis]))),
                offset = hn::Set(d, std::abs(double(t.offset[axis])));
      in = hn::And(in, hn::Lt(hn::Add(hn::Mul(far, scale), offset), hn::Set(d, double(kVectorLimit) / 2.0)));
    }
    return in;
  }
};

void append_seen_simd(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& t,
                      uint32_t instance, uint32_t first, uint32_t last, std::vector<ClusterDraw>& out) {
  const int lanes = int(hn::Lanes(D64()));
  Bounds b;
  for (uint32_t i = first; i < last; i += uint32_t(lanes)) {
    b.set(boxes, transform, t, i);
    for (uint32_t bits = b.seen & range_bits(0, int(last - i) - 1, 0, lanes); bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      ClusterDraw draw{instance,
                       i + uint32_t(k),
                       -std::numeric_limits<float>::infinity(),
                       false,
                       uint16_t(t.x0),
                       uint16_t(t.y0),
                       uint16_t(t.x1 - 1),
                       uint16_t(t.y1 - 1)};
      if (((b.unknown >> k) & 1) == 0)
        draw = {instance,          draw.cluster,      b.near[k],         ((b.plain >> k) & 1) != 0,
                uint16_t(b.x0[k]), uint16_t(b.y0[k]), uint16_t(b.x1[k]), uint16_t(b.y1[k])};
      out.push_back(draw);
    }
  }
}

bool may_be_seen_simd(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& t,
                      uint32_t index) {
  Bounds b;
  b.set(boxes, transform, t, index);
  return (b.seen & 1) != 0;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(append_seen_simd);
HWY_EXPORT(may_be_seen_simd);

void append_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t instance, uint32_t first, uint32_t last, std::vector<ClusterDraw>& out) {
  HWY_DYNAMIC_DISPATCH(append_seen_simd)(boxes, transform, window, instance, first, last, out);
}

bool may_be_seen(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& window,
                 uint32_t index) {
  return HWY_DYNAMIC_DISPATCH(may_be_seen_simd)(boxes, transform, window, index);
}
}  // namespace trueshade
#endif  // HWY_ONCE
