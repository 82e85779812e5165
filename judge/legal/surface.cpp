#include "judge/legal/surface.h"

#include <limits>

namespace trueshade::oracle {

namespace {

double float_spacing(double magnitude) {
  const auto m = float(magnitude);
  return double(std::nextafter(m, std::numeric_limits<float>::infinity())) - double(m);
}

}  // namespace

SurfacePoint::SurfacePoint(const Piece& piece, const Profile& profile, const Pair& window_reach, double x, double y)
    : piece_(piece), own_shape_(std::in_place, piece, profile, window_reach), shape_(*own_shape_), profile_(profile) {
  find_samples(x, y, Within::box);
}

SurfacePoint::SurfacePoint(const Piece& piece, const PieceShape& shape, const Profile& profile, double x, double y,
                           Within within)
    : piece_(piece), shape_(shape), profile_(profile) {
  find_samples(x, y, within);
}

void SurfacePoint::find_samples(double x, double y, Within within) {
  at_ = {x, y};
  const auto& v = piece_.v;
  std::array<double, 3> edge{};
  for (size_t i = 0; i < 3; ++i) {
    const Pair &a = v[(i + 1) % 3].plane, &b = v[(i + 2) % 3].plane;
    edge[i] = (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x);
    lambda_[i].fill(edge[i] / shape_.area);
  }
  if (shape_.area == 0) {
    no_plane(x, y);
    return;
  }
  if (shape_.points) return;

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
  const double smallest_area = std::fabs(shape_.area) - area_change;
  if (!(smallest_area > 0)) {
    no_plane(x, y);
    return;
  }
  if (within == Within::middle) return;
  double shift[2] = {0, 0};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 2; ++k) shift[k] += (std::fabs(edge[i]) + change[i]) / smallest_area * v[i].plane_reach[k];
  points_ = 5;
  const double qx[] = {-shift[0], shift[0], -shift[0], shift[0]}, qy[] = {-shift[1], -shift[1], shift[1], shift[1]};
  for (size_t i = 0; i < 3; ++i)
    for (size_t c = 0; c < 4; ++c) lambda_[i][c + 1] = lambda_[i][0] + qx[c] * shape_.dx[i] + qy[c] * shape_.dy[i];
}

void SurfacePoint::no_plane(double x, double y) {
  bounded_ = false;
  if (profile_.exact_planes || profile_.plane_origin == PlaneOrigin::unsnapped || piece_.submitted) return;
  // What is left inside the view is snapped anew and covers the sample; the plane is that of the whole triangle.
  if (profile_.planes == PlaneForm::homogeneous && piece_.leaves_view) return;
  tiny_ = Tiny::hull;
  if (profile_.plane_origin == PlaneOrigin::snapped) return;
  bool same = true;
  float_piece_ = std::make_unique<Piece>(piece_);
  for (WindowVertex& v : float_piece_->v) {
    same = same && v.plane == v.exact && v.plane_reach == v.float_reach;
    v.plane = v.exact, v.plane_reach = v.float_reach;
  }
  tiny_ = same ? Tiny::anything : Tiny::hull_and_plane;
  if (!same) unsnapped_ = std::make_unique<SurfacePoint>(*float_piece_, profile_, shape_.window_reach, x, y);
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

double plane_error_of(const Piece& piece, const PieceShape& shape, const std::array<double, 3>& value,
                      Interpolation interpolation) {
  if (interpolation != Interpolation::smooth) return shape.plane_error(value);
  return shape.plane_error({value[0] * piece.v[0].u, value[1] * piece.v[1].u, value[2] * piece.v[2].u});
}

template <size_t kSamples>
Range SurfacePoint::affine(const VertexAttribute& vertices) const {
  const std::array<double, 3>&value = vertices.value, &error = vertices.error;
  const double d0 = value[0] - value[0], d1 = value[1] - value[0], d2 = value[2] - value[0];
  std::array<double, kSamples> at, carried;
  for (size_t k = 0; k < kSamples; ++k) {  // from differences, so that constants stay constant
    at[k] = value[0] + lambda_[0][k] * d0 + lambda_[1][k] * d1 + lambda_[2][k] * d2;
    carried[k] =
        std::fabs(lambda_[0][k]) * error[0] + std::fabs(lambda_[1][k]) * error[1] + std::fabs(lambda_[2][k]) * error[2];
  }
  Range r{at[0], at[0], at[0]};
  double inherited = 0;
  bool known = true;  // a vertex that is cut next to w = 0 lies beyond what a double tells
  for (size_t k = 0; k < kSamples; ++k) {
    known = known && !std::isnan(at[k] + carried[k]);
    r.low = std::min(r.low, at[k]), r.high = std::max(r.high, at[k]);
    inherited = std::max(inherited, carried[k]);
  }
  if (!known) return kAnyValue;
  const double more = inherited + vertices.plane_error;
  return {r.value, r.low - more, r.high + more};
}

Range SurfacePoint::depth() const {
  std::array<double, 3> z{}, error{};
  for (size_t i = 0; i < 3; ++i) z[i] = piece_.v[i].z, error[i] = piece_.v[i].z_error;
  if (!bounded()) return {z[0], -HUGE_VAL, HUGE_VAL};
  if (!bounded_) return of_tiny(z, error, unsnapped_ ? unsnapped_->depth() : Range{z[0], z[0], z[0]});
  if (!profile_.exact_planes) return affine({z, error, shape_.z_error});
  double at = z[0], largest = 1;
  for (size_t i = 0; i < 3; ++i) {
    at += lambda_[i][0] * (z[i] - z[0]);
    largest = std::max(largest, std::fabs(z[i]));
  }
  // The stated formula has some ten roundings in double (docs/arithmetic.md section 5).
  return {at, at - largest * 0x1p-47, at + largest * 0x1p-47};
}

void SurfacePoint::find_divisors(bool smooth, Divisors& out) const {
  const size_t samples = points_ == 1 ? 1 : out.value.size();
  for (size_t i = 0; i < 3; ++i) {
    const double u = smooth ? piece_.v[i].u : 1, off = smooth ? piece_.v[i].u_error : 0;
    for (size_t k = 0; k < samples; ++k) {
      out.weight[i][k] = lambda_[i][k] * u;
      out.moves[i][k] = std::fabs(lambda_[i][k]) * u;
      out.moves_by_u[i][k] = std::fabs(lambda_[i][k]) * off;
    }
  }
  for (size_t k = 0; k < points_; ++k) {
    double d = 0, u_moves = 0;
    for (size_t i = 0; i < 3; ++i) d += out.weight[i][k], u_moves += out.moves_by_u[i][k];
    out.above_zero = out.above_zero && d - u_moves > 0;
    out.value[k] = d, out.least_value[k] = d - u_moves;
    out.least = std::min(out.least, d - u_moves);
  }
  out.value[5] = out.value[0], out.least_value[5] = out.least_value[0];
  out.error = smooth ? shape_.u_error : 0;
}

Range SurfacePoint::attribute(const std::array<double, 3>& value, const std::array<double, 3>& error,
                              Interpolation interpolation) const {
  VertexAttribute vertices{value, error, 0};
  if (bounded_ && !profile_.exact_planes) vertices.plane_error = plane_error_of(piece_, shape_, value, interpolation);
  return attribute(vertices, interpolation);
}

Range SurfacePoint::attribute(const VertexAttribute& vertices, Interpolation interpolation) const {
  const std::array<double, 3>&value = vertices.value, &error = vertices.error;
  const bool smooth = interpolation == Interpolation::smooth;
  if (bounded_) {
    if (!smooth && !profile_.exact_planes) return affine(vertices);
    if (smooth && !smooth_) find_divisors(true, smooth_.emplace(Divisors{}));
    if (smooth) return points_ == 1 ? quotient<1>(vertices, *smooth_) : quotient<6>(vertices, *smooth_);
    Divisors divisors;
    find_divisors(false, divisors);
    return quotient<1>(vertices, divisors);  // of exact planes, whose vertices are points
  }
  const double low = std::min({value[0], value[1], value[2]}), high = std::max({value[0], value[1], value[2]});
  if (!bounded()) return profile_.exact_planes ? Range{value[0], low, high} : kAnyValue;
  return of_tiny(value, error,
                 unsnapped_ ? unsnapped_->attribute(value, error, interpolation) : Range{value[0], value[0], value[0]});
}

template <size_t kSamples>
Range SurfacePoint::quotient(const VertexAttribute& vertices, const Divisors& divisors) const {
  const std::array<double, 3>&value = vertices.value, &error = vertices.error;
  if (!divisors.above_zero) return kAnyValue;
  const double d0 = value[0] - value[0], d1 = value[1] - value[0], d2 = value[2] - value[0];
  Range r{value[0], value[0], value[0]};
  double inherited = 0;
  const bool is_constant = d1 == 0 && d2 == 0 && error[0] == 0 && error[1] == 0 && error[2] == 0;
  if (!is_constant) {
    const auto &w = divisors.weight, &m = divisors.moves, &u = divisors.moves_by_u;
    std::array<double, kSamples> at, moved;
    for (size_t k = 0; k < kSamples; ++k) {
      at[k] = value[0] + (w[0][k] * d0 + w[1][k] * d1 + w[2][k] * d2) / divisors.value[k];
      const double by_values = m[0][k] * error[0] + m[1][k] * error[1] + m[2][k] * error[2];
      moved[k] = (by_values + u[0][k] * std::fabs(value[0] - at[k]) + u[1][k] * std::fabs(value[1] - at[k]) +
                  u[2][k] * std::fabs(value[2] - at[k])) /
                 divisors.least_value[k];
    }
    r = {at[0], at[0], at[0]};
    for (size_t k = 0; k < kSamples; ++k) {
      r.low = std::min(r.low, at[k]), r.high = std::max(r.high, at[k]);
      inherited = std::max(inherited, moved[k]);
    }
  }
  const double low = std::min({value[0], value[1], value[2]}), high = std::max({value[0], value[1], value[2]});
  const double largest = std::max(std::fabs(low), std::fabs(high));
  if (profile_.exact_planes) {
    const double ulp = low == high ? 0 : float_spacing(largest);
    return {std::clamp(r.value, low, high), std::max(low, r.value - ulp), std::min(high, r.value + ulp)};
  }
  const double d_error = divisors.error, least_divisor = divisors.least;
  if (!(least_divisor - d_error > 0)) return kAnyValue;
  const double v = profile_.arithmetic.roundoff;
  const double more = inherited + (vertices.plane_error + largest * d_error) / (least_divisor - d_error) +
                      (profile_.arithmetic.divide + 2 * v) * largest;
  return {r.value, r.low - more, r.high + more};
}

TriangleValues triangle_values(const Projector& projector, uint32_t instance, uint32_t triangle) {
  const Scene& scene = projector.scene();
  const Instance& drawn = scene.instances[instance];
  const Mesh& mesh = scene.meshes[drawn.mesh];
  const UnitNormals unit_normals = projector.pipeline().gbuffer.unit_normals;
  TriangleValues t;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = mesh.indices[3 * size_t(triangle) + i];
    t.value[i] = vertex_values(scene, drawn, projector.clip_from_world(), unit_normals, vertex);
    if (projector.profile().exact_vertices) continue;
    // Five roundings theirs (products, sums, the matrix element), four ours, per term of the sums.
    const double step = 5 * projector.profile().arithmetic.roundoff + 4 * 0x1p-24;
    for (size_t r = 0; r < 3; ++r) {
      double size = std::fabs(double(drawn.world_from_object[3][int(r)]));
      for (size_t c = 0; c < 3; ++c)
        size += std::fabs(double(drawn.world_from_object[int(c)][int(r)]) * double(mesh.position[c][vertex]));
      t.error[i][kPosition + r] = step * size;
    }
    for (size_t r = 0; r < 3 && mesh.has_tangents(); ++r)
      for (size_t c = 0; c < 3; ++c)
        t.error[i][kTangent + r] +=
            step * std::fabs(double(drawn.world_from_object[int(c)][int(r)]) * double(mesh.tangent[c][vertex]));
    if (!made_unit_at_vertex(unit_normals)) {
      const InstanceRows rows = instance_rows(drawn, projector.clip_from_world());
      for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3 && !mesh.normal[c].empty(); ++c)
          t.error[i][kNormal + r] += step * std::fabs(double(rows.normal[r][c]) * double(mesh.normal[c][vertex]));
      continue;
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

void piece_values(const Piece& piece, const TriangleValues& values, size_t index, Interpolation interpolation,
                  std::array<double, 3>& value, std::array<double, 3>& error) {
  const bool linear = interpolation == Interpolation::noperspective;
  for (size_t i = 0; i < 3; ++i) {
    const auto& w = linear ? piece.v[i].linear : piece.v[i].weight;
    value[i] = error[i] = 0;
    if (!piece.cut) {
      value[i] = values.value[i][index], error[i] = values.error[i][index];
      continue;
    }
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (size_t k = 0; k < 3; ++k) {
      value[i] += w[k] * values.value[k][index], error[i] += std::fabs(w[k]) * values.error[k][index];
      least = std::min(least, values.value[k][index]), most = std::max(most, values.value[k][index]);
    }
    if (linear) error[i] += 2 * piece.v[i].linear_error * (most - least);
    if (w[0] < 1 && w[1] < 1 && w[2] < 1 && error[i] > 0) error[i] += 4 * 0x1p-23 * std::fabs(value[i]);
  }
}

}  // namespace trueshade::oracle
