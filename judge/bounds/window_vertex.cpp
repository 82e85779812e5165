#include <algorithm>
#include <cmath>

#include "judge/bounds/window.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

void Projector::snap(WindowVertex& v, int axis_index, const ClipVertex& clip, double error, double along,
                     bool leaves_view) const {
  const auto axis = size_t(axis_index);
  const double scale = std::ldexp(1.0, profile_.subpixel_bits), t = v.exact[axis] * scale, e = (error + along) * scale;
  switch (profile_.snap) {
    case SnapRule::nearest:
      v.low[axis] = std::nearbyint(t - e), v.high[axis] = std::nearbyint(t + e);
      break;
    case SnapRule::nearest_0_6:
      v.low[axis] = std::ceil(t - e - 0.6), v.high[axis] = std::floor(t + e + 0.6);
      break;
    case SnapRule::toward_zero:
      v.low[axis] = std::floor(t - e), v.high[axis] = std::floor(t + e);
      break;
    case SnapRule::unstated:
      v.low[axis] = t - e - 0.6, v.high[axis] = t + e + 0.6;
      break;
  }
  if (profile_.exact_vertices && profile_.snap == SnapRule::nearest && profile_.subpixel_bits == 8 &&
      std::fabs(std::fabs(t - std::trunc(t)) - 0.5) <= 0x1p-45 * (std::fabs(t) + 1)) {
    // So near a tie that a double cannot tell: the quotient in 128 bits.
    bool huge = false;
    const double numerator =
        axis == 1 && pipeline_.geometry.clip_origin == ClipOrigin::upper_left ? -clip.c[1] : clip.c[axis];
    const int size = axis == 0 ? viewport_.width : viewport_.height, corner = axis == 0 ? viewport_.x : viewport_.y;
    const int64_t fixed = window_coordinate(numerator, clip.c[3], size, corner, &huge);
    if (!huge) v.low[axis] = v.high[axis] = double(fixed);
  }
  // A cut vertex is snapped again, off the edge by up to half a subpixel; a convex combination of boxes holds it.
  if (leaves_view && profile_.clips_to_view)
    v.low[axis] = std::min(v.low[axis], t - e - 0.5), v.high[axis] = std::max(v.high[axis], t + e + 0.5);
  v.low[axis] /= scale;
  v.high[axis] /= scale;
  const double low_plane = v.low[axis] + along, high_plane = v.high[axis] - along;
  const double middle = (low_plane + high_plane) / 2, half = (high_plane - low_plane) / 2;
  switch (profile_.plane_origin) {
    case PlaneOrigin::snapped:
      v.plane[axis] = middle, v.plane_reach[axis] = half;
      break;
    case PlaneOrigin::unsnapped:
      v.plane[axis] = v.exact[axis], v.plane_reach[axis] = error;
      break;
    case PlaneOrigin::either: {
      const double low = std::min(low_plane, v.exact[axis] - error), high = std::max(high_plane, v.exact[axis] + error);
      v.plane[axis] = (low + high) / 2, v.plane_reach[axis] = (high - low) / 2;
      break;
    }
  }
}

WindowVertex Projector::window_vertex(const ClipVertex& c, bool leaves_view) const {
  WindowVertex v;
  v.weight = c.weight;
  const double w = c.c[3], room = std::max(std::fabs(w) - c.error[3], 0x1p-20 * std::fabs(w));
  const bool exact = profile_.exact_vertices;
  for (int a = 0; a < 2; ++a) {
    const auto axis = size_t(a);
    const double half = (a == 0 ? viewport_.width : viewport_.height) * 0.5,
                 corner = a == 0 ? viewport_.x : viewport_.y;
    double ndc = c.c[axis] / w;
    if (a == 1 && pipeline_.geometry.clip_origin == ClipOrigin::upper_left) ndc = -ndc;
    v.exact[axis] = ndc * half + (half + corner);
    // docs/gl_rules.md section 9: fp32 divide and viewport, 2^-23 (2 |x/w| px/2 + |xw|); and what the clip error comes
    // to.
    const double error = exact ? 0
                               : half * (c.error[axis] + std::fabs(ndc) * c.error[3]) / room +
                                     0x1p-23 * (2 * std::fabs(ndc) * half + std::fabs(v.exact[axis] + drawn_at_[axis]));
    v.float_reach[axis] = error;
    const double along = half * (c.along[axis] + std::fabs(ndc) * c.along[3]) / std::max(w - c.along[3], 0x1p-20 * w);
    snap(v, a, c, error, along, leaves_view);
  }
  const double ndc_z = c.c[2] / w;
  v.z = ndc_z * z_scale_ + z_offset_;
  v.u = 1 / w;
  if (exact) return v;
  const double v1 = profile_.arithmetic.roundoff;
  v.z_error = std::fabs(z_scale_) * (c.error[2] + std::fabs(ndc_z) * c.error[3]) / room +
              (profile_.arithmetic.divide + 2 * v1) * std::fabs(ndc_z * z_scale_) + 2 * v1 * std::fabs(z_offset_);
  v.u_error = std::fabs(v.u) * (c.error[3] / room + profile_.arithmetic.divide);
  return v;
}

}  // namespace trueshade::oracle
