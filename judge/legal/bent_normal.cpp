#include "judge/legal/bent_normal.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr Range kAnything{0, -HUGE_VAL, HUGE_VAL};

/// docs/arithmetic.md bends in double, and rounds once at the end.
constexpr Arithmetic kDouble{0x1p-52, 0x1p-52, 0x1p-51, 0x1p-52, true};

const Arithmetic& arithmetic_of(const Profile& profile) { return profile.exact_planes ? kDouble : profile.arithmetic; }

double length(const Bounded3& v) { return std::hypot(v[0].value, v[1].value, v[2].value); }
double error_of(const Bounded3& v) { return std::hypot(v[0].error, v[1].error, v[2].error); }

Range range_about(const Bounded& b, double more) { return {b.value, b.low() - more, b.high() + more}; }

Range times(const Range& a, const Range& b) {
  const double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {a.value * b.value, *std::min_element(p, p + 4), *std::max_element(p, p + 4)};
}
double size_of(const Range& r) { return std::max(std::fabs(r.low), std::fabs(r.high)); }
Range hull(const Range& a, const Range& b) { return {a.value, std::min(a.low, b.low), std::max(a.high, b.high)}; }

/// 2 t - 1, then times the scale where it is not 1: doubling is exact.
Range direction_of(const Range& texel, double scale, const Arithmetic& a) {
  const auto at = [scale](double t) { return (2 * t - 1) * scale; };
  Range r{at(texel.value), std::min(at(texel.low), at(texel.high)), std::max(at(texel.low), at(texel.high))};
  const double more = 2 * a.roundoff * size_of(r) + kSmallestFloat;
  return {r.value, r.low - more, r.high + more};
}

Bounded3 cross(const Arithmetic& a, const Bounded3& x, const Bounded3& y) {
  Bounded3 r;
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    r[k] = difference(a, product(a, x[i], y[j]), product(a, x[j], y[i]));
  }
  return r;
}

/// T and B as ranges, B in both senses where its sign is open.
struct Across {
  std::array<Range, 3> t, b;
  bool open = true;  ///< nothing is known of either, and there may be no frame at all
};

constexpr Range kDirection{0, -1 - 0x1p-20, 1 + 0x1p-20};

Across across(const Bounded3& n, double n_error, const TangentFrame& frame, const Arithmetic& a) {
  Across out;
  out.t.fill(kDirection), out.b.fill(kDirection);
  const Bounded n2 = dot(a, n, n), q = quotient(a, dot(a, n, frame.u), n2);
  Bounded3 t;
  for (size_t k = 0; k < 3; ++k) t[k] = difference(a, frame.u[k], product(a, n[k], q));
  const Bounded t_inverse = inverse_sqrt(a, dot(a, t, t)), n_inverse = inverse_sqrt(a, n2);
  for (Bounded& c : t) c = product(a, c, t_inverse);
  const Bounded3 c = cross(a, n, t);
  const double size = length(n), theta = n_error / (size - n_error);
  const double longest_inverse = t_inverse.value + t_inverse.error;  // over all that U may be
  const double sine = longest_inverse > 0 ? 1 / (longest_inverse * (length(frame.u) + error_of(frame.u))) : 0;
  const double turned = theta / (sine - theta);
  if (!std::isfinite(t_inverse.error) || !(size > n_error) || !(sine > theta) || turned > 1) return out;
  out.open = false;
  const Bounded side = frame.side != 0 ? Bounded{double(frame.side), 0} : dot(a, c, frame.v);
  const double moved = (n_error + turned * size) * (length(frame.v) + error_of(frame.v));
  const bool either = frame.either_side || std::fabs(side.value) <= side.error + moved;
  for (size_t k = 0; k < 3; ++k) {
    out.t[k] = range_about(t[k], turned);
    const Range b = range_about(product(a, c[k], n_inverse), turned), other{-b.value, -b.high, -b.low};
    out.b[k] = side.value < 0 ? other : b;
    if (either) out.b[k] = hull(out.b[k], side.value < 0 ? b : other);
  }
  return out;
}

}  // namespace

TangentFrame vertex_frame(const Projector& projector, uint32_t instance, uint32_t triangle) {
  const Instance& drawn = projector.scene().instances[instance];
  const Mesh& mesh = projector.scene().meshes[drawn.mesh];
  float corners = 0;
  for (size_t i = 0; i < 3; ++i) corners += mesh.tangent[3][mesh.indices[3 * size_t(triangle) + i]];
  const glm::mat4x3& m = drawn.world_from_object;
  double determinant = 0, size = 0;
  for (int k = 0; k < 3; ++k)
    for (const int way : {1, 2}) {
      const double term = double(m[0][k]) * double(m[1][(k + way) % 3]) * double(m[2][(k + 3 - way) % 3]);
      determinant += way == 1 ? term : -term, size += std::fabs(term);
    }
  TangentFrame frame;
  frame.side = (corners < 0) == (determinant < 0) ? 1 : -1;
  const double unsure = 8 * projector.profile().arithmetic.roundoff * size + 0x1p-120;  // floats round, vanish
  frame.either_side = !projector.profile().exact_vertices && (std::fabs(determinant) <= unsure || size > 0x1p120);
  return frame;
}

TangentFrame tangent_frame(const Projector& projector, uint32_t instance, uint32_t triangle,
                           const TriangleValues& values, size_t uv_set) {
  const Scene& scene = projector.scene();
  const Instance& drawn = scene.instances[instance];
  const Mesh& mesh = scene.meshes[drawn.mesh];
  const auto& p = values.value;
  const size_t u = uv_index(uv_set), v = u + 1;
  const double a1 = p[1][u] - p[0][u], b1 = p[1][v] - p[0][v];
  const double a2 = p[2][u] - p[0][u], b2 = p[2][v] - p[0][v], area = a1 * b2 - a2 * b1;
  TangentFrame frame;
  if (area == 0) return frame;
  const double sign = area < 0 ? -1 : 1;
  const auto grows = [&](Bounded3& out, double first, double second) {  // first e1 + second e2
    std::array<double, 3> object{};
    for (size_t k = 0; k < 3; ++k) {
      const auto at = [&](size_t i) { return double(mesh.position[k][mesh.indices[3 * size_t(triangle) + i]]); };
      object[k] = sign * (first * (at(1) - at(0)) + second * (at(2) - at(0)));
    }
    for (size_t r = 0; r < 3; ++r) {
      const double e1 = p[1][kPosition + r] - p[0][kPosition + r], e2 = p[2][kPosition + r] - p[0][kPosition + r];
      const double ours = sign * (first * e1 + second * e2);
      out[r] = {ours, 0x1p-50 * (std::fabs(first * e1) + std::fabs(second * e2))};
      if (projector.profile().exact_vertices) continue;
      double turned = 0, size = 0;
      for (size_t c = 0; c < 3; ++c) {
        const double m = double(drawn.world_from_object[int(c)][int(r)]);
        turned += m * object[c], size += std::fabs(m * object[c]);
      }
      const double error = std::fabs(turned - ours) / 2 + 5 * projector.profile().arithmetic.roundoff * size;
      out[r] = {(turned + ours) / 2, out[r].error + error};
    }
  };
  grows(frame.u, b2, -b1);
  grows(frame.v, -a2, a1);
  return frame;
}

std::array<Range, 3> bent_normal(const std::array<Range, 3>& normal, const TangentFrame& frame,
                                 const std::array<Range, 4>& texel, double scale, const Profile& profile) {
  const Arithmetic& a = arithmetic_of(profile);
  Bounded3 n;
  double n_error = 0;
  for (size_t k = 0; k < 3; ++k) {
    n[k] = {normal[k].value, 0};
    n_error = std::hypot(n_error, std::max(normal[k].high - normal[k].value, normal[k].value - normal[k].low));
  }
  if (!std::isfinite(n_error)) return {kAnything, kAnything, kAnything};
  const bool no_frame = length(frame.u) == 0 && error_of(frame.u) == 0;
  if (no_frame || (length(n) == 0 && n_error == 0)) return normal;
  const Range x = direction_of(texel[0], scale, a), y = direction_of(texel[1], scale, a),
              z = direction_of(texel[2], 1, a);
  const Across d = across(n, n_error, frame, a);
  std::array<Range, 3> out;
  for (size_t k = 0; k < 3; ++k) {
    const Range parts[3] = {times(d.t[k], x), times(d.b[k], y), times(normal[k], z)};
    Range sum;
    double size = 0;
    for (const Range& part : parts) {
      sum = {sum.value + part.value, sum.low + part.low, sum.high + part.high};
      size += size_of(part);
    }
    double more = 3 * a.roundoff * size + 3 * kSmallestFloat;
    if (profile.exact_planes) more += 0x1p-24 * size_of(sum);
    out[k] = {sum.value, sum.low - more, sum.high + more};
    if (d.open) out[k] = hull(out[k], normal[k]);
  }
  return out;
}

}  // namespace trueshade::oracle
