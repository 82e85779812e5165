#include "core/simd/one_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/simd/lanes-inl.h"
#include "raster/clusters/cluster_bounds.h"
#include "raster/fixed_point.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using MWF = hn::Mask<DWF>;
using IWF = hn::Rebind<int32_t, DWF>;

// Clip coordinates over a cluster's box, a lane a cluster. With u = 2^-24 and M the sum of a row's terms' magnitudes
// over the box: the vertex stage's row is off by at most 4 u M, ours at a corner by 8 u M, the ends of a sum of two
// rows by 10 u of both M more. Slack is 16 u M, of such sums 32 u M.
struct ClipRow {
  VWF middle, half[3];  ///< at the box's centre; from there to each pair of faces
  VWF slack;            ///< more than what rounding, of the vertex stage and here, may move it by

  HWY_INLINE ClipRow(const VWF row[4], const VWF center[3], const VWF half_size[3]) {
    const DWF d;
    middle = row[3];
    VWF magnitude = hn::Abs(row[3]);
    for (int i = 0; i < 3; ++i) {
      const VWF m = row[i], from_center = hn::Mul(m, center[i]);
      half[i] = hn::Mul(m, half_size[i]);
      middle = hn::Add(middle, from_center);
      magnitude = hn::Add(magnitude, hn::Add(hn::Abs(from_center), hn::Abs(half[i])));
    }
    slack = hn::Add(hn::Mul(magnitude, hn::Set(d, 0x1p-20f)), hn::Set(d, 0x1p-100f));
  }
};

struct Intervals {
  VWF low, high;
};

// What w + sign * z can be, sign 0, 1 or -1: z and w of a perspective view are nearly the same.
HWY_INLINE Intervals sum_interval(const ClipRow& w, const ClipRow& z, float sign) {
  const VWF s = hn::Set(DWF(), sign), middle = hn::Add(w.middle, hn::Mul(s, z.middle));
  VWF reach = hn::Mul(hn::Add(w.slack, z.slack), hn::Set(DWF(), 2.0f));
  for (int i = 0; i < 3; ++i) reach = hn::Add(reach, hn::Abs(hn::Add(w.half[i], hn::Mul(s, z.half[i]))));
  return {hn::Sub(middle, reach), hn::Add(middle, reach)};
}

// x / w, y / w and z / w of a box in front of the eye. A quotient of two linear functions is monotone along every line
// on which w > 0, so its ends are at corners. A vertex whose x and w are off by dx and dw has one that is off by less
// than (dx + |x / w| dw) / w; the quotient's own roundings are below 5 u of it.
HWY_INLINE void quotients(const ClipRow row[3], const ClipRow& w, VWF least_w, Intervals out[3]) {
  const DWF d;
  const VWF none = hn::Set(d, std::numeric_limits<float>::infinity());
  for (int r = 0; r < 3; ++r) out[r] = {none, hn::Neg(none)};
  for (int corner = 0; corner < 8; ++corner) {
    const auto at = [corner](const ClipRow& r) {
      VWF value = r.middle;
      for (int i = 0; i < 3; ++i) value = (corner >> i) & 1 ? hn::Add(value, r.half[i]) : hn::Sub(value, r.half[i]);
      return value;
    };
    const VWF u = hn::Div(hn::Set(d, 1.0f), at(w));
    for (int r = 0; r < 3; ++r) {
      const VWF q = hn::Mul(at(row[r]), u);
      out[r] = {hn::Min(out[r].low, q), hn::Max(out[r].high, q)};
    }
  }
  const VWF u = hn::Div(hn::Set(d, 1.0f), least_w);
  for (int r = 0; r < 3; ++r) {
    const VWF most = hn::Max(hn::Abs(out[r].low), hn::Abs(out[r].high));
    const VWF moved = hn::Mul(hn::Add(row[r].slack, hn::Mul(most, w.slack)), u);
    const VWF slack = hn::Add(moved, hn::Mul(most, hn::Set(d, 0x1.8p-22f)));
    out[r] = {hn::Sub(out[r].low, slack), hn::Add(out[r].high, slack)};
  }
}

// Pixels [first, last] whose samples intervals of normalized device coordinates can reach, if any; snapping moves a
// vertex by far less than the margin, and roundings here where a sum comes to lie in an image, whose places are below
// 2^16, by less than 2^-22 of what is added. Returns the lanes that have any.
HWY_INLINE MWF pixel_spans(const Intervals& ndc, const WindowTransform& t, int axis, int low, int high, int32_t* first,
                           int32_t* last) {
  const DWF d;
  const IWF di;
  const double center = double(t.offset[axis]) / 256.0;
  const auto margin = float(0.25 + (std::abs(center) + 0x1p16) * 0x1p-22);  // pixels
  const VWF scale = hn::Set(d, float(double(t.scale[axis]) / 256.0)), offset = hn::Set(d, float(center));
  const VWF least = hn::Set(d, float(low)), most = hn::Set(d, float(high - 1));
  const VWF a = hn::Add(hn::Mul(ndc.low, scale), offset), b = hn::Add(hn::Mul(ndc.high, scale), offset);
  const VWF from = hn::Floor(hn::Add(hn::Min(a, b), hn::Set(d, 0.5f - margin)));
  const VWF to = hn::Floor(hn::Add(hn::Max(a, b), hn::Set(d, margin - 0.5f)));
  const auto x0 = hn::ConvertTo(di, hn::Min(hn::Max(from, least), most));
  const auto x1 = hn::ConvertTo(di, hn::Min(hn::Max(to, least), most));
  hn::Store(x0, di, first);
  hn::Store(x1, di, last);
  return hn::And(hn::Le(from, to), hn::And(hn::Ge(to, least), hn::Le(from, most)));
}

constexpr int kMostLanes = HWY_MAX_BYTES / sizeof(float);

// A cluster of a run.
struct LaneCluster {
  const ClusterRun* run;
  uint32_t cluster;
};

// Boxes and the clip space they are seen in, a lane each.
struct BoxLanes {
  VWF row[4][4], center[3], half[3];

  // An instance's boxes from the i-th on.
  HWY_INLINE BoxLanes(const ClusterBoxes& boxes, const InstanceTransform& instance, size_t i) {
    const DWF d;
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) row[r][c] = hn::Set(d, instance.clip[r][c]);
    for (size_t c = 0; c < 3; ++c) {
      center[c] = hn::LoadU(d, boxes.center[c].data() + i);
      half[c] = hn::LoadU(d, boxes.half_size[c].data() + i);
    }
  }

  // Boxes of any instances, one each.
  HWY_INLINE explicit BoxLanes(const LaneCluster* of) {
    const DWF d;
    constexpr size_t kNumbers = 16 + 6;
    alignas(64) float lane[kNumbers][kMostLanes];
    for (size_t k = 0; k < hn::Lanes(d); ++k) {
      const float* const clip = of[k].run->transform->clip[0];
      const ClusterBoxes& boxes = of[k].run->mesh->boxes;
      for (size_t n = 0; n < 16; ++n) lane[n][k] = clip[n];
      for (size_t c = 0; c < 3; ++c) {
        lane[16 + c][k] = boxes.center[c][of[k].cluster];
        lane[19 + c][k] = boxes.half_size[c][of[k].cluster];
      }
    }
    for (size_t n = 0; n < 16; ++n) row[n / 4][n % 4] = hn::Load(d, lane[n]);
    for (size_t c = 0; c < 3; ++c) center[c] = hn::Load(d, lane[16 + c]), half[c] = hn::Load(d, lane[19 + c]);
  }
};

// Bounds of a vector of clusters.
struct Bounds {
  static constexpr int kMost = kMostLanes;
  alignas(64) int32_t x0[kMost], y0[kMost], x1[kMost], y1[kMost];
  alignas(64) float near[kMost];
  uint32_t seen, unknown, no_clip;  // a bit a lane: may be seen; somewhere in the viewport; needs no clipping

  HWY_INLINE void set(const BoxLanes& in, const WindowTransform& t) {
    const DWF d;
    const ClipRow row[3] = {
        {in.row[0], in.center, in.half}, {in.row[1], in.center, in.half}, {in.row[2], in.center, in.half}};
    const ClipRow w_row(in.row[3], in.center, in.half);
    const Intervals w = sum_interval(w_row, row[2], 0.0f), before_far = sum_interval(w_row, row[2], -1.0f);
    const Intervals behind_near = t.zero_to_one ? sum_interval(row[2], w_row, 0.0f) : sum_interval(w_row, row[2], 1.0f);
    const VWF zero = hn::Zero(d);
    VWF nothing = difference(w);
    for (const ClipRow& r : row) nothing = hn::Add(nothing, difference(sum_interval(r, w_row, 0.0f)));
    const MWF finite = hn::Eq(nothing, zero);
    MWF gone = hn::Le(w.high, zero), clipped = hn::Le(w.low, zero);
    if (!t.depth_clamp) {
      gone = hn::Or(gone, hn::Or(hn::Lt(behind_near.high, zero), hn::Lt(before_far.high, zero)));
      clipped = hn::Or(clipped, hn::Lt(behind_near.low, zero));
    }
    for (int axis = 0; axis < 2; ++axis) gone = hn::Or(gone, beside(row[axis], w_row, w, t, axis));
    Intervals ndc[3];
    quotients(row, w_row, w.low, ndc);
    const MWF across = pixel_spans(ndc[0], t, 0, t.x0, t.x1, x0, x1),
              up = pixel_spans(ndc[1], t, 1, t.y0, t.y1, y0, y1);
    VWF beyond = zero;  // of floats
    for (const Intervals& quotient : ndc) beyond = hn::Add(beyond, difference(quotient));
    const MWF unbounded = hn::Or(clipped, hn::Not(hn::Eq(beyond, zero)));
    const uint32_t somewhere = lane_bits(d, hn::Or(hn::Not(finite), hn::AndNot(gone, unbounded)));
    const uint32_t here = lane_bits(d, hn::And(hn::And(finite, hn::Not(gone)), hn::And(across, up)));
    seen = somewhere | here;
    unknown = somewhere;
    const VWF scale = hn::Set(d, float(t.z_scale)), offset = hn::Set(d, float(t.z_offset));
    const VWF least = hn::Min(hn::Mul(ndc[2].low, scale), hn::Mul(ndc[2].high, scale));
    const VWF slack =
        hn::Add(hn::Mul(hn::Add(hn::Abs(least), hn::Abs(offset)), hn::Set(d, 0x1p-22f)), hn::Set(d, 0x1p-40f));
    hn::Store(hn::Sub(hn::Add(least, offset), slack), d, near);
    no_clip = lane_bits(d, without_clip(ndc, before_far, w, t)) & ~somewhere;
  }

 private:
  static HWY_INLINE VWF difference(const Intervals& a) {  // not 0 where an end is infinite or NaN
    const VWF sum = hn::Add(a.low, a.high);
    return hn::Sub(sum, sum);
  }

  // Boxes beside the viewport, wherever they lie to the near plane: what clipping leaves of them has w > 0 and x / w
  // past an end of [-1, 1] by two pixels and more, which no snapping brings back. The same of y.
  static HWY_INLINE MWF beside(const ClipRow& row, const ClipRow& w_row, const Intervals& w, const WindowTransform& t,
                               int axis) {
    const DWF d;
    const float two_pixels = 512.0f / std::abs(float(t.scale[axis]));
    const VWF margin = hn::Mul(hn::Max(hn::Abs(w.low), hn::Abs(w.high)), hn::Set(d, two_pixels));
    const auto past = [&](float sign) {
      return hn::Lt(hn::Add(sum_interval(w_row, row, sign).high, margin), hn::Zero(d));
    };
    return hn::Or(past(1.0f), past(-1.0f));
  }

  // Boxes in front of the near plane that lie wholly where project_vertices() finds nothing that needs clipping.
  static HWY_INLINE MWF without_clip(const Intervals ndc[2], const Intervals& before_far, const Intervals& w,
                                     const WindowTransform& t) {
    const DWF d;
    MWF in = hn::Ge(w.low, hn::Set(d, t.float_snap ? std::numeric_limits<float>::infinity() : 0x1p-100f));
    if (!t.depth_clamp) in = hn::And(in, hn::Ge(before_far.low, hn::Zero(d)));
    for (int axis = 0; axis < 2; ++axis) {
      const VWF far = hn::Max(hn::Abs(ndc[axis].low), hn::Abs(ndc[axis].high));
      const VWF scale = hn::Set(d, std::abs(float(t.scale[axis]))),
                offset = hn::Set(d, std::abs(float(t.offset[axis])));
      in = hn::And(in, hn::Lt(hn::Add(hn::Mul(far, scale), offset), hn::Set(d, float(kVectorLimit) / 2.0f)));
    }
    return in;
  }
};

ClusterDraw draw_of(const Bounds& b, int k, const WindowTransform& t, uint32_t instance, uint32_t cluster) {
  if (((b.unknown >> k) & 1) == 0)
    return {instance,          cluster,           b.near[k],         ((b.no_clip >> k) & 1) != 0,
            uint16_t(b.x0[k]), uint16_t(b.y0[k]), uint16_t(b.x1[k]), uint16_t(b.y1[k])};
  return {instance,
          cluster,
          -std::numeric_limits<float>::infinity(),
          false,
          uint16_t(t.x0),
          uint16_t(t.y0),
          uint16_t(t.x1 - 1),
          uint16_t(t.y1 - 1)};
}

// A vector of clusters after the other: of one run where it has so many left, else of several.
void append_seen_simd(std::span<const ClusterRun> runs, const WindowTransform& t, std::vector<ClusterDraw>& out) {
  const auto lanes = uint32_t(hn::Lanes(DWF()));
  Bounds b;
  LaneCluster lane[kMostLanes];
  uint32_t i = runs.empty() ? 0 : runs[0].first;
  for (size_t at = 0; at < runs.size();) {
    const ClusterRun& run = runs[at];
    const bool alone = run.last - i >= lanes || at + 1 == runs.size();
    if (alone) b.set(BoxLanes(run.mesh->boxes, *run.transform, i), t);
    uint32_t count = 0;
    for (; count < lanes && at < runs.size(); ++count) {
      lane[count] = {&runs[at], i};
      if (++i == runs[at].last && ++at < runs.size()) i = runs[at].first;
    }
    if (!alone) {
      std::fill(lane + count, lane + lanes, lane[count - 1]);
      b.set(BoxLanes(lane), t);
    }
    for (uint32_t bits = b.seen & ((uint32_t(1) << count) - 1); bits != 0; bits &= bits - 1) {
      const int k = std::countr_zero(bits);
      out.push_back(draw_of(b, k, t, lane[k].run->instance, lane[k].cluster));
    }
  }
}

bool may_be_seen_simd(const ClusterBoxes& boxes, const InstanceTransform& transform, const WindowTransform& t,
                      uint32_t index) {
  Bounds b;
  b.set(BoxLanes(boxes, transform, index), t);
  return (b.seen & 1) != 0;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace trueshade {
TRUESHADE_KERNEL(append_seen, HWY_NAMESPACE::append_seen_simd);
TRUESHADE_KERNEL(may_be_seen, HWY_NAMESPACE::may_be_seen_simd);
}  // namespace trueshade
