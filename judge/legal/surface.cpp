#include "judge/legal/surface.h"

#include <limits>

namespace trueshade::oracle {

namespace {

double float_spacing(double magnitude) {
  const auto m = float(magnitude);
  return double(std::nextafter(m, std::numeric_limits<float>::infinity())) - double(m);
}

constexpr Range kAnyValue{0, -HUGE_VAL, HUGE_VAL};

/// The code of depth 1, 0 for floats.
double fixed_point_codes(const GeometryState& state) {
  const FormatInfo layout = info(state.depth_format);
  return layout.number_class == NumberClass::unorm ? double(layout.largest_code(0)) : 0;
}

}  // namespace

SurfacePoint::SurfacePoint(const Piece& piece, const Profile& profile, const Pair& window_reach, double x, double y)
    : piece_(piece), profile_(profile), window_reach_(window_reach) {
  const auto& v = piece.v;
  double reach[2] = {0, 0};
  for (const WindowVertex& p : v)
    for (size_t k = 0; k < 2; ++k) reach[k] = std::max(reach[k], p.plane_reach[k]);
  const bool points = reach[0] == 0 && reach[1] == 0;
  std::array<double, 3> edge{};
  const auto edges_at = [&](double px, double py, std::array<double, 3>& e) {
    for (size_t i = 0; i < 3; ++i) {
      const Pair &a = v[(i + 1) % 3].plane, &b = v[(i + 2) % 3].plane;
      e[i] = (a[0] - px) * (b[1] - py) - (a[1] - py) * (b[0] - px);
    }
  };
  edges_at(x, y, edge);
  area_ = (v[1].plane[0] - v[0].plane[0]) * (v[2].plane[1] - v[0].plane[1]) -
          (v[1].plane[1] - v[0].plane[1]) * (v[2].plane[0] - v[0].plane[0]);
  for (size_t i = 0; i < 3; ++i) {
    const Pair &a = v[(i + 1) % 3].plane, &b = v[(i + 2) % 3].plane;
    dx_[i] = (a[1] - b[1]) / area_;
    dy_[i] = (b[0] - a[0]) / area_;
    span_x_ = std::max(span_x_, std::fabs(a[0] - b[0]));
    span_y_ = std::max(span_y_, std::fabs(a[1] - b[1]));
    lambda_[0][i] = edge[i] / area_;
  }
  if (area_ == 0) {
    no_plane(x, y);
    return;
  }
  condition_ = 2 * span_x_ * span_y_ / std::fabs(area_);
  if (points) return;

  // With A and B the ends about the sample, E = Ax By - Ay Bx changes by at most the sum of |end| times the other's
  // reach.
  std::array<double, 3> change{};
  double area_change = 0;
  for (size_t i = 0; i < 3; ++i) {
    const WindowVertex &a = v[(i + 1) % 3], &b = v[(i + 2) % 3];
    const auto moved = [&](size_t p, size_t q, double other_p, double other_q) {
      return std::fabs(a.plane[p] - other_p) * b.plane_reach[q] + std::fabs(b.plane[q] - other_q) * a.plane_reach[p] +
             a.plane_reach[p] * b.plane_reach[q];
    };
    change[i] = moved(0, 1, x, y) + moved(1, 0, y, x);
    area_change += change[i];
  }
  const double smallest_area = std::fabs(area_) - area_change;
  if (!(smallest_area > 0)) {
    no_plane(x, y);
    return;
  }
  double shift[2] = {0, 0};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 2; ++k) shift[k] += (std::fabs(edge[i]) + change[i]) / smallest_area * v[i].plane_reach[k];
  points_ = 5;
  for (size_t corner = 1; corner < 5; ++corner) {
    const double qx = ((corner & 1) != 0 ? 1 : -1) * shift[0], qy = ((corner & 2) != 0 ? 1 : -1) * shift[1];
    for (size_t i = 0; i < 3; ++i) lambda_[corner][i] = lambda_[0][i] + qx * dx_[i] + qy * dy_[i];
  }
}

void SurfacePoint::no_plane(double x, double y) {
  bounded_ = false;
  if (profile_.exact_planes || profile_.plane_origin == PlaneOrigin::unsnapped) return;
  tiny_ = Tiny::hull;
  if (profile_.plane_origin == PlaneOrigin::snapped) return;
  bool same = true;
  float_piece_ = std::make_unique<Piece>(piece_);
  for (WindowVertex& v : float_piece_->v) {
    same = same && v.plane == v.exact && v.plane_reach == v.float_reach;
    v.plane = v.exact, v.plane_reach = v.float_reach;
  }
  tiny_ = same ? Tiny::anything : Tiny::hull_and_plane;
  if (!same) unsnapped_ = std::make_unique<SurfacePoint>(*float_piece_, profile_, window_reach_, x, y);
}

Range SurfacePoint::of_tiny(const std::array<double, 3>& value, const std::array<double, 3>& error,
                            const Range& plane) const {
  Range r{plane.value, HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < 3; ++i)
    r.low = std::min(r.low, value[i] - error[i]), r.high = std::max(r.high, value[i] + error[i]);
  const double width = r.high - r.low;
  r.low = std::min(r.low - width, plane.low), r.high = std::max(r.high + width, plane.high);
  return {std::clamp(r.value, r.low, r.high), r.low, r.high};
}

double SurfacePoint::plane_error(const std::array<double, 3>& n) const {
  const double v = profile_.arithmetic.roundoff;
  double gx = 0, gy = 0, largest = 0, spread = 0;
  for (size_t i = 0; i < 3; ++i) {
    gx += dx_[i] * n[i];
    gy += dy_[i] * n[i];
    largest = std::max(largest, std::fabs(n[i]));
    spread = std::max(spread, std::fabs(n[i] - n[(i + 1) % 3]));
  }
  gx = std::fabs(gx), gy = std::fabs(gy);
  const double anchored = gx * window_reach_[0] + gy * window_reach_[1];
  const double sums_x = 2 * spread * span_y_ / std::fabs(area_), sums_y = 2 * spread * span_x_ / std::fabs(area_);  // G
  const double det = 3 * condition_ * v + profile_.arithmetic.divide + v;
  const double setup = (4 * v * sums_x + gx * det) * span_x_ + (4 * v * sums_y + gy * det) * span_y_;
  return setup + 10 * v * anchored + 4 * v * largest;
}

Range SurfacePoint::affine(const std::array<double, 3>& value, const std::array<double, 3>& error) const {
  Range r;
  double inherited = 0;
  for (size_t k = 0; k < size_t(points_); ++k) {
    double at = value[0], carried = 0;  // from differences, so that constants stay constant
    for (size_t i = 0; i < 3; ++i) {
      at += lambda_[k][i] * (value[i] - value[0]);
      carried += std::fabs(lambda_[k][i]) * error[i];
    }
    if (k == 0) r = {at, at, at};
    r.low = std::min(r.low, at), r.high = std::max(r.high, at);
    inherited = std::max(inherited, carried);
  }
  const double more = inherited + plane_error(value);
  return {r.value, r.low - more, r.high + more};
}

Range SurfacePoint::depth() const {
  std::array<double, 3> z{}, error{};
  for (size_t i = 0; i < 3; ++i) z[i] = piece_.v[i].z, error[i] = piece_.v[i].z_error;
  if (!bounded()) return {z[0], -HUGE_VAL, HUGE_VAL};
  if (!bounded_) return of_tiny(z, error, unsnapped_ ? unsnapped_->depth() : Range{z[0], z[0], z[0]});
  if (!profile_.exact_planes) return affine(z, error);
  double at = z[0], largest = 1;
  for (size_t i = 0; i < 3; ++i) {
    at += lambda_[0][i] * (z[i] - z[0]);
    largest = std::max(largest, std::fabs(z[i]));
  }
  // The stated formula has some ten roundings in double (docs/arithmetic.md section 5).
  return {at, at - largest * 0x1p-47, at + largest * 0x1p-47};
}

Range SurfacePoint::depth_offset(const GeometryState& state, double largest) const {
  const double factor = double(state.polygon_offset_factor), units = double(state.polygon_offset_units);
  if (factor == 0 && units == 0) return {};
  if (!bounded_) return kAnyValue;
  double gx = 0, gy = 0, spread = 0, reach = 0;
  for (size_t i = 0; i < 3; ++i) {
    gx += dx_[i] * piece_.v[i].z;
    gy += dy_[i] * piece_.v[i].z;
    spread = std::max(spread, std::fabs(piece_.v[i].z - piece_.v[(i + 1) % 3].z) + 2 * piece_.v[i].z_error);
    for (const double r : piece_.v[i].plane_reach) reach = std::max(reach, r);
  }
  gx = std::fabs(gx), gy = std::fabs(gy);
  Range m{std::max(gx, gy), std::max(gx, gy), profile_.max_norm_slope ? std::max(gx, gy) : std::hypot(gx, gy)};
  if (!profile_.exact_planes) {
    // Moving the ends of a plane's edges by 2 reach moves its slope by share = |inverse| 4 reach of what it becomes.
    const double share = 4 * reach * (span_x_ + span_y_) / std::fabs(area_);
    if (!(share < 1)) return kAnyValue;
    const double v = profile_.arithmetic.roundoff, det = 3 * condition_ * v + profile_.arithmetic.divide + v;
    double errors = 0;  // of the vertices' depths
    for (const WindowVertex& p : piece_.v) errors = std::max(errors, p.z_error);
    const double sums = 2 * (4 * v * spread + 2 * errors) * (span_x_ + span_y_) / std::fabs(area_);
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

SurfacePoint::Divisors SurfacePoint::divisors_of(bool smooth) const {
  Divisors out;
  std::array<double, 3> u{};
  for (size_t i = 0; i < 3; ++i) u[i] = piece_.v[i].u;
  for (size_t k = 0; k < size_t(points_); ++k) {
    double d = 0, u_moves = 0;
    for (size_t i = 0; i < 3; ++i) {
      d += lambda_[k][i] * (smooth ? u[i] : 1);
      if (smooth) u_moves += std::fabs(lambda_[k][i]) * piece_.v[i].u_error;
    }
    out.above_zero = out.above_zero && d - u_moves > 0;
    out.value[k] = d, out.moves[k] = u_moves;
    out.least = std::min(out.least, d - u_moves);
  }
  out.error = plane_error(u);
  return out;
}

Range SurfacePoint::attribute(const std::array<double, 3>& value, const std::array<double, 3>& error,
                              Interpolation interpolation) const {
  const double low = std::min({value[0], value[1], value[2]}), high = std::max({value[0], value[1], value[2]});
  if (!bounded()) return profile_.exact_planes ? Range{value[0], low, high} : kAnyValue;
  if (!bounded_)
    return of_tiny(
        value, error,
        unsnapped_ ? unsnapped_->attribute(value, error, interpolation) : Range{value[0], value[0], value[0]});
  const bool smooth = interpolation == Interpolation::smooth;
  if (!smooth && !profile_.exact_planes) return affine(value, error);

  if (smooth && !smooth_) smooth_ = divisors_of(true);
  const Divisors divisors = smooth ? *smooth_ : divisors_of(false);
  if (!divisors.above_zero) return kAnyValue;
  Range r;
  double inherited = 0;
  for (size_t k = 0; k < size_t(points_); ++k) {
    double n = 0, carried = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double u = smooth ? piece_.v[i].u : 1;
      n += lambda_[k][i] * u * (value[i] - value[0]);
      carried += std::fabs(lambda_[k][i]) * u * error[i];
    }
    const double d = divisors.value[k], u_moves = divisors.moves[k];
    const double at = value[0] + n / d;
    double moved = carried;
    if (smooth)
      for (size_t i = 0; i < 3; ++i) moved += std::fabs(lambda_[k][i]) * piece_.v[i].u_error * std::fabs(value[i] - at);
    if (k == 0) r = {at, at, at};
    r.low = std::min(r.low, at), r.high = std::max(r.high, at);
    inherited = std::max(inherited, moved / (d - u_moves));
  }
  const double largest = std::max(std::fabs(low), std::fabs(high));
  if (profile_.exact_planes) {
    const double ulp = low == high ? 0 : float_spacing(largest);
    return {std::clamp(r.value, low, high), std::max(low, r.value - ulp), std::min(high, r.value + ulp)};
  }
  std::array<double, 3> n{};
  for (size_t i = 0; i < 3; ++i) n[i] = value[i] * piece_.v[i].u;
  const double d_error = divisors.error, least_divisor = divisors.least;
  if (!(least_divisor - d_error > 0)) return kAnyValue;
  const double v = profile_.arithmetic.roundoff;
  double more = inherited + (plane_error(n) + largest * d_error) / (least_divisor - d_error) +
                (profile_.arithmetic.divide + 2 * v) * largest;
  return {r.value, r.low - more, r.high + more};
}

TriangleValues triangle_values(const Projector& projector, uint32_t instance, uint32_t triangle) {
  const Scene& scene = projector.scene();
  const Instance& drawn = scene.instances[instance];
  const Mesh& mesh = scene.meshes[drawn.mesh];
  TriangleValues t;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = mesh.indices[3 * size_t(triangle) + i];
    t.value[i] = vertex_values(scene, drawn, projector.clip_from_world(), vertex);
    if (projector.profile().exact_vertices) continue;
    // Five roundings theirs (products, sums, the matrix element), four ours, per term of the sums.
    const double step = 5 * projector.profile().arithmetic.roundoff + 4 * 0x1p-24;
    for (size_t r = 0; r < 3; ++r) {
      double size = std::fabs(double(drawn.world_from_object[3][int(r)]));
      for (size_t c = 0; c < 3; ++c)
        size += std::fabs(double(drawn.world_from_object[int(c)][int(r)]) * double(mesh.position[c][vertex]));
      t.error[i][kPosition + r] = step * size;
    }
    // Of a normal m n of length l, each component errs by step * sum|m||n| before it is made unit: twice that over l
    // after, and the root's own error. sum|m||n| <= l * (ratio of the matrix's largest to smallest stretch).
    double longest = 0, shortest = HUGE_VAL;
    for (int c = 0; c < 3; ++c) {
      double length = 0;
      for (int r = 0; r < 3; ++r)
        length += double(drawn.world_from_object[c][r]) * double(drawn.world_from_object[c][r]);
      longest = std::max(longest, std::sqrt(length)), shortest = std::min(shortest, std::sqrt(length));
    }
    const double ratio = shortest > 0 ? longest / shortest : HUGE_VAL;
    const Arithmetic& a = projector.profile().arithmetic;
    for (size_t k = 0; k < 3; ++k)
      t.error[i][kNormal + k] = 2 * std::sqrt(3.0) * step * ratio + 3 * a.roundoff + a.inverse_sqrt;
  }
  return t;
}

void piece_values(const Piece& piece, const TriangleValues& values, size_t index, std::array<double, 3>& value,
                  std::array<double, 3>& error) {
  for (size_t i = 0; i < 3; ++i) {
    const auto& w = piece.v[i].weight;
    value[i] = error[i] = 0;
    if (!piece.cut) {
      value[i] = values.value[i][index], error[i] = values.error[i][index];
      continue;
    }
    for (size_t k = 0; k < 3; ++k) value[i] += w[k] * values.value[k][index], error[i] += w[k] * values.error[k][index];
    if (w[0] < 1 && w[1] < 1 && w[2] < 1 && error[i] > 0) error[i] += 4 * 0x1p-23 * std::fabs(value[i]);
  }
}

Range stored_depth(const SurfacePoint& point, const GeometryState& state, const Profile& profile, double largest) {
  const double near = double(state.depth_near), far = double(state.depth_far), codes = fixed_point_codes(state);
  const bool offset = state.polygon_offset_factor != 0 || state.polygon_offset_units != 0;
  const bool whole = offset && !state.depth_clamp;
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
