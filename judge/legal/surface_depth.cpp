// Depths of a surface: what a polygon offset adds, and what the buffer holds of them.
#include <algorithm>
#include <cmath>

#include "judge/legal/surface.h"

namespace trueshade::oracle {

namespace {

/// The code of depth 1, 0 for floats.
double fixed_point_codes(const GeometryState& state) {
  const FormatInfo layout = info(state.depth_format);
  return layout.number_class == NumberClass::unorm ? double(layout.largest_code(0)) : 0;
}

/// The inverse of a triangle's edges, in 1/pixel: how much its plane turns where a vertex is moved.
double turn_of(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
  double span = 0;
  for (size_t k = 0; k < 2; ++k)
    span += std::max({a.plane[k], b.plane[k], c.plane[k]}) - std::min({a.plane[k], b.plane[k], c.plane[k]});
  const double area =
      (b.plane[0] - a.plane[0]) * (c.plane[1] - a.plane[1]) - (b.plane[1] - a.plane[1]) * (c.plane[0] - a.plane[0]);
  return span / std::fabs(area);
}

bool may_cover(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c, const Profile& profile,
               const Pair& at) {
  Piece piece;
  piece.v = {a, b, c};
  piece.facing_known = false;
  return coverage_at(piece, profile, ClipOrigin::lower_left, at[0], at[1]).cover != Cover::no;
}

}  // namespace

/// The largest turn_of() any piece that a driver may have made of the triangle at the sample.
double SurfacePoint::steepest() const {
  double most = (shape_.span_x + shape_.span_y) / std::fabs(shape_.area);
  if (!piece_.polygons) return most;
  for (const std::vector<WindowVertex>& p : *piece_.polygons)
    for (size_t a = 0; a < p.size(); ++a)
      for (size_t b = 0; b < a; ++b)
        for (size_t c = 0; c < b; ++c)
          if (const double turn = turn_of(p[a], p[b], p[c]); turn > most && may_cover(p[a], p[b], p[c], profile_, at_))
            most = turn;
  return most;
}

Range SurfacePoint::depth_offset(const GeometryState& state, double largest) const {
  const double factor = double(state.polygon_offset_factor), units = double(state.polygon_offset_units);
  if (factor == 0 && units == 0) return {};
  if (!bounded_) return kAnyValue;
  double gx = 0, gy = 0, spread = 0, reach = 0;
  for (size_t i = 0; i < 3; ++i) {
    gx += shape_.dx[i] * piece_.v[i].z;
    gy += shape_.dy[i] * piece_.v[i].z;
    spread = std::max(spread, std::fabs(piece_.v[i].z - piece_.v[(i + 1) % 3].z) + 2 * piece_.v[i].z_error);
    for (const double r : piece_.v[i].plane_reach) reach = std::max(reach, r);
  }
  gx = std::fabs(gx), gy = std::fabs(gy);
  Range m{std::max(gx, gy), std::max(gx, gy), profile_.max_norm_slope ? std::max(gx, gy) : std::hypot(gx, gy)};
  if (!profile_.exact_planes) {
    // Moving the ends of a plane's edges by 2 reach moves its slope by share = |inverse| 4 reach of what it becomes.
    const double turn = steepest(), share = 4 * reach * turn;
    if (!(share < 1)) return kAnyValue;
    const double v = profile_.arithmetic.roundoff, det = 3 * shape_.condition * v + profile_.arithmetic.divide + v;
    double errors = 0;  // of the vertices' depths
    for (const WindowVertex& p : piece_.v) errors = std::max(errors, p.z_error);
    const double sums = 2 * (4 * v * spread + 2 * errors) * turn;
    m.low = std::max(0.0, m.low * (1 - share / (1 - share)) - sums - m.low * det);
    m.high = m.high * (1 + share / (1 - share)) + sums + m.high * det;
  }
  Range r;
  if (const double codes = fixed_point_codes(state); codes > 0) {
    r = {profile_.least_depth_unit / codes, profile_.least_depth_unit / codes, profile_.most_depth_unit / codes};
  } else {
    const double slack = profile_.exact_planes ? 0 : 0x1p-20;
    const auto unit = [&](double z) {
      return std::ldexp(1.0, std::ilogb(std::clamp(float(z), 0x1p-126f, 0x1p127f)) - 23);
    };
    double least = largest, most = largest;
    if (!profile_.exact_planes && (piece_.cut || piece_.leaves_view)) {
      // Whatever triangles a driver cuts it into: the sample's has some vertex as deep as the sample, none past the
      // range.
      const Range here = depth();
      least = std::min(least, std::max({here.low, -here.high, 0.0}));
      if (piece_.cut) most = std::max({most, std::fabs(double(state.depth_near)), std::fabs(double(state.depth_far))});
    }
    r = {unit(largest), unit(least * (1 - slack)), unit(most * (1 + slack))};
  }
  const auto low = [](const Range& x, double by) { return by * (by < 0 ? x.high : x.low); };
  const auto high = [](const Range& x, double by) { return by * (by < 0 ? x.low : x.high); };
  return {m.value * factor + r.value * units, low(m, factor) + low(r, units), high(m, factor) + high(r, units)};
}

Range stored_depth(const SurfacePoint& point, const GeometryState& state, const Profile& profile, double largest) {
  const double near = double(state.depth_near), far = double(state.depth_far), codes = fixed_point_codes(state);
  const bool offset = state.polygon_offset_factor != 0 || state.polygon_offset_units != 0;
  // A depth beyond the viewport's range, as a plane through moved vertices may have it, is held to that range under
  // depth clamp alone (GL 4.6 core, 17.3.4; Vulkan 1.3, "Depth Clamping and Range Adjustment").
  const bool whole = !state.depth_clamp && (offset || !profile.exact_planes);
  const double low = whole ? 0 : std::min(near, far), high = whole ? 1 : std::max(near, far);
  Range z = point.depth();
  if (offset) {
    const Range o = point.depth_offset(state, largest);
    largest += std::max(std::fabs(o.low), std::fabs(o.high));
    z = {z.value + o.value, z.low + o.low, z.high + o.high};
    if (profile.exact_planes) z.low -= largest * 0x1p-50, z.high += largest * 0x1p-50;
  }
  if (!profile.exact_planes) {
    const double ulp = std::isfinite(largest) ? profile.arithmetic.roundoff * largest : 0;  // storing rounds once more
    z = {std::clamp(z.value, low, high), std::clamp(z.low - ulp, low, high), std::clamp(z.high + ulp, low, high)};
  } else {
    const auto rounded = [&](double v) { return double(float(std::clamp(v, low, high))); };
    z = {rounded(z.value), rounded(z.low), rounded(z.high)};
  }
  if (codes == 0) return z;
  const auto nearest = [&](double v) { return std::nearbyint(double(float(v) * float(codes))); };
  Range code{nearest(z.value), nearest(z.low), nearest(z.high)};
  if (!profile.exact_planes && profile.unorm_reach != 0.5) {
    code.low = std::min(code.low, std::max(0.0, std::floor(z.low * codes * (1 - 0x1p-24))));
    code.high = std::max(code.high, std::min(codes, std::ceil(z.high * codes * (1 + 0x1p-24))));
    // 0 and 1, where depths are clamped, have one code (GL 4.6 core, 2.3.5.2).
    if (z.low >= 1) code.low = codes;
    if (z.high <= 0) code.high = 0;
  }
  return {code.value / codes, code.low / codes, code.high / codes};
}

double depth_in_buffer(const GeometryState& state, double depth) {
  const double codes = fixed_point_codes(state);
  return codes == 0 ? depth : std::nearbyint(depth * codes) / codes;
}

bool is_clear_depth(const GeometryState& state, double depth) {
  const double codes = fixed_point_codes(state), clear = double(state.clear_depth);
  return codes == 0 ? depth == clear : std::fabs(depth_in_buffer(state, depth) - clear) * codes < 1;
}

}  // namespace trueshade::oracle
