#include "raster/triangles/clip.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "raster/fixed_point.h"
#include "raster/triangles/snap.h"
#include "raster/triangles/wide_integer.h"

namespace trueshade {
namespace {

enum Plane : uint8_t { kW, kNear, kFar, kRight, kLeft, kTop, kBottom };
constexpr double kSmallestW = 0x1p-126;  // below it a float is denormal, which OpenGL may take for 0

// A plane's distance is a sum of terms: two clip coordinates (each with a sign), or one and a constant.
struct PlaneTerms {
  int axis;         // x, y or z; 3 for the plane of w alone
  double sign;      // of that axis
  double w_factor;  // of w
  double constant;
};

double far_box(const WindowTransform& t) {
  return 0x1p38 / double(std::max(std::abs(t.scale[0]), std::abs(t.scale[1])));  // 2^31 / pixels
}

PlaneTerms terms(Plane plane, const WindowTransform& t) {
  switch (plane) {
    case kW:
      return {3, 1.0, 0.0, -kSmallestW};
    case kNear:
      return {2, 1.0, t.zero_to_one ? 0.0 : 1.0, 0.0};
    case kFar:
      return {2, -1.0, 1.0, 0.0};
    case kRight:
      return {0, -1.0, far_box(t), 0.0};
    case kLeft:
      return {0, 1.0, far_box(t), 0.0};
    case kTop:
      return {1, -1.0, far_box(t), 0.0};
    case kBottom:
      return {1, 1.0, far_box(t), 0.0};
  }
  return {};
}

double distance(const PlaneTerms& p, const double c[4]) {
  return (c[p.axis] * p.sign + c[3] * p.w_factor) + p.constant;
}

// On which side, exactly: comparing two numbers needs no sum.
bool inside(const PlaneTerms& p, const double c[4]) { return c[p.axis] * p.sign >= -(c[3] * p.w_factor) - p.constant; }

// Exponent of the last bit of a float's mantissa, or a large number for 0.
int last_bit(double value) {
  if (value == 0.0) return 1000;
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent - 24;
}

// A sum or product of two doubles and what rounding left of it, exact (Dekker 1971, Knuth 1969).
struct Exact {
  double value, rest;
};
Exact exact_sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
Exact exact_product(double a, double b) {
  const double ca = 134217729.0 * a, cb = 134217729.0 * b;
  const double ah = ca - (ca - a), bh = cb - (cb - b), al = a - ah, bl = b - bh, p = a * b;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

// The crossing in pairs of doubles, about 100 bits, where that settles the rounding to 53; nothing where it does not.
std::optional<double> quick_crossing(const PlaneTerms& p, const ClipVertex& va, const ClipVertex& vb, double a,
                                     double b) {
  const double ca[4] = {double(va.c[0]), double(va.c[1]), double(va.c[2]), double(va.c[3])};
  const double cb[4] = {double(vb.c[0]), double(vb.c[1]), double(vb.c[2]), double(vb.c[3])};
  // The constant takes part as constant * (a - b), and not at all in the divisor.
  const double by_constant = p.constant * (a - b);
  const Exact da = exact_sum(ca[p.axis] * p.sign, ca[3] * p.w_factor),
              db = exact_sum(cb[p.axis] * p.sign, cb[3] * p.w_factor);
  const Exact den = exact_sum(db.value, -da.value);
  if (da.rest != 0.0 || db.rest != 0.0 || den.rest != 0.0) return std::nullopt;
  const Exact left = exact_product(a, db.value), right = exact_product(b, da.value);
  const Exact high = exact_sum(left.value, -right.value), low = exact_sum(left.rest, -right.rest);
  const Exact mid = exact_sum(high.rest, low.value);
  if (std::abs(high.value) < std::abs(left.value) * 0x1p-30) return std::nullopt;   // the parts cancel
  if (std::abs(by_constant) > std::abs(high.value) * 0x1p-40) return std::nullopt;  // its own rounding would count
  const double n0 = high.value, n1 = mid.value, n2 = mid.rest + (low.rest + by_constant);
  const double q1 = (n0 + n1) / den.value;
  if (!(std::abs(q1) > 1e-200 && std::abs(q1) < 1e200)) return std::nullopt;
  const Exact back = exact_product(q1, den.value);
  const double rest = ((((n0 - back.value) - back.rest) + n1) + n2) / den.value;
  const Exact q = exact_sum(q1, rest);
  // Where the rest is this far from half a unit of the last place, no error of the pair can turn the rounding.
  int exponent = 0;
  const double fraction = std::frexp(std::abs(q.value), &exponent);
  const double half_unit = std::ldexp(1.0, exponent - (fraction == 0.5 ? 55 : 54));
  if (std::abs(std::abs(q.rest) - half_unit) < half_unit * 0x1p-20 ||
      (fraction == 0.5 && std::abs(q.rest) > half_unit * 0.5))
    return std::nullopt;
  return q.value;
}

// (a*db - b*da) / (db - da), exact, rounded once; da and db the plane's distances at the two ends.
double exact_crossing(const PlaneTerms& p, const ClipVertex& va, const ClipVertex& vb, float a, float b) {
  if (a == b) return double(a);
  if (p.axis == 3 && a == va.c[3] && b == vb.c[3]) return -p.constant;  // w on the plane of w
  if (const std::optional<double> quick = quick_crossing(p, va, vb, double(a), double(b))) return *quick;
  const double ca[2] = {double(va.c[p.axis]) * p.sign, double(va.c[3]) * p.w_factor};
  const double cb[2] = {double(vb.c[p.axis]) * p.sign, double(vb.c[3]) * p.w_factor};
  const int unit = std::min({last_bit(ca[0]), last_bit(ca[1]), last_bit(cb[0]), last_bit(cb[1]), last_bit(p.constant)});
  const auto wide_distance = [&](const double c[2]) {
    return WideInteger::from_double(c[0], unit) + WideInteger::from_double(c[1], unit) +
           WideInteger::from_double(p.constant, unit);
  };
  const WideInteger da = wide_distance(ca), db = wide_distance(cb);
  const int value_unit = std::min(last_bit(double(a)), last_bit(double(b)));
  const WideInteger numerator =
      WideInteger::from_double(double(a), value_unit) * db - WideInteger::from_double(double(b), value_unit) * da;
  return WideInteger::rounded_quotient(numerator, db - da, value_unit);
}

int other_vertex(int edge, int not_this) { return 3 - edge - not_this; }

// The original edge that both corners lie on, or -1.
int shared_edge(const ClipCorner& p, const ClipCorner& q) {
  const int both = p.edges & q.edges;
  return both == 0 ? -1 : both & 1 ? 0 : both & 2 ? 1 : 2;
}

int add_crossing(ClippedPolygon& polygon, int from, int to, Plane plane, const ClipVertex v[3],
                 const WindowTransform& t) {
  const PlaneTerms p = terms(plane, t);
  ClipCorner made{};
  made.plane = plane;
  const int edge = shared_edge(polygon.all[from], polygon.all[to]);
  if (edge >= 0 && plane <= kFar) {
    made.kind = 1;
    made.a = uint8_t((edge + 1) % 3);
    made.b = uint8_t(other_vertex(edge, made.a));
    made.edges = uint8_t(1 << edge);
    for (int i = 0; i < 4; ++i) made.c[i] = exact_crossing(p, v[made.a], v[made.b], v[made.a].c[i], v[made.b].c[i]);
  } else {  // from inside to outside, so that both triangles of a shared edge compute alike
    const bool forward = inside(p, polygon.all[from].c);
    const ClipCorner& in = polygon.all[forward ? from : to];
    const ClipCorner& out = polygon.all[forward ? to : from];
    made.kind = 2;
    made.a = uint8_t(forward ? from : to);
    made.b = uint8_t(forward ? to : from);
    made.edges = edge >= 0 ? uint8_t(1 << edge) : uint8_t(0);
    const double da = distance(p, in.c), db = distance(p, out.c);
    made.t = da / (da - db);
    const double s = db / (db - da);  // 1 - t would lose a small share, and w of the corner with it
    for (int i = 0; i < 4; ++i) made.c[i] = in.c[i] * s + out.c[i] * made.t;
    if (plane >= kRight) made.c[p.axis] = -p.sign * (p.w_factor * made.c[3]);  // on the box, whatever x and y cancelled
  }
  polygon.all[polygon.made] = made;
  return polygon.made++;
}

void cut(ClippedPolygon& polygon, Plane plane, const ClipVertex v[3], const WindowTransform& t) {
  const PlaneTerms p = terms(plane, t);
  uint8_t kept[ClippedPolygon::kCorners];
  int count = 0;
  for (int i = 0; i < polygon.corners; ++i) {
    const int from = polygon.corner[i], to = polygon.corner[(i + 1) % polygon.corners];
    const bool from_in = inside(p, polygon.all[from].c), to_in = inside(p, polygon.all[to].c);
    // A convex polygon gains one corner a cut. Should roundings of the far-away box ever make it less than convex, the
    // triangle is dropped rather than memory harmed.
    if (count + 2 > ClippedPolygon::kCorners || polygon.made == ClippedPolygon::kMax) {
      polygon.corners = 0;
      return;
    }
    if (from_in) kept[count++] = uint8_t(from);
    if (from_in != to_in) kept[count++] = uint8_t(add_crossing(polygon, from, to, plane, v, t));
  }
  std::copy(kept, kept + count, polygon.corner);
  polygon.corners = count < 3 ? 0 : count;
}

bool beyond_box(const ClippedPolygon& polygon, const WindowTransform& t) {
  for (int i = 0; i < polygon.corners; ++i)
    for (int axis = 0; axis < 2; ++axis)
      if (!snapped(t, axis, polygon.at(i).c[axis], polygon.at(i).c[3])) return true;
  return false;
}

}  // namespace

ClippedPolygon clip_triangle(const ClipVertex v[3], const WindowTransform& window) {
  ClippedPolygon polygon;
  for (int i = 0; i < 3; ++i) {
    ClipCorner& corner = polygon.all[polygon.made++];
    corner = {};
    for (int k = 0; k < 4; ++k) {
      if (!std::isfinite(v[i].c[k])) return {};
      corner.c[k] = double(v[i].c[k]);
    }
    corner.a = uint8_t(i);
    corner.edges = uint8_t(7 & ~(1 << i));
    polygon.corner[i] = uint8_t(i);
  }
  polygon.corners = 3;
  if (!window.depth_clamp) {
    cut(polygon, kNear, v, window);
    cut(polygon, kFar, v, window);
  }
  for (int i = 0; i < polygon.corners;
       ++i) {  // between near and far w is at least 0; only without them, or at 0, this cuts
    if (polygon.at(i).c[3] >= kSmallestW) continue;
    cut(polygon, kW, v, window);
    break;
  }
  if (polygon.corners != 0 && beyond_box(polygon, window))
    for (const Plane plane : {kRight, kLeft, kTop, kBottom}) cut(polygon, plane, v, window);
  return polygon;
}

double corner_attribute(const ClippedPolygon& polygon, int index, const ClipVertex v[3], const WindowTransform& window,
                        float v0, float v1, float v2) {
  const float value[3] = {v0, v1, v2};
  const ClipCorner& corner = polygon.all[index];
  if (corner.kind == 0) return double(value[corner.a]);
  if (corner.kind == 1)
    return exact_crossing(terms(Plane(corner.plane), window), v[corner.a], v[corner.b], value[corner.a],
                          value[corner.b]);
  const double a = corner_attribute(polygon, corner.a, v, window, v0, v1, v2);
  const double b = corner_attribute(polygon, corner.b, v, window, v0, v1, v2);
  return a + (b - a) * corner.t;
}

}  // namespace trueshade
