#pragma once
// Three doubles as a vector.
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

namespace trueshade::oracle {

using Triple3 = std::array<double, 3>;

/// The inner product.
inline double inner(const Triple3& a, const Triple3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Triple3 plus(const Triple3& a, const Triple3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Triple3 minus(const Triple3& a, const Triple3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Triple3 times(const Triple3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
/// The vector with its floats as doubles.
inline Triple3 triple(const glm::vec3& v) { return {double(v.x), double(v.y), double(v.z)}; }
/// The vector with each double rounded to a float.
inline glm::vec3 vec3_of(const Triple3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }
inline Triple3 cross(const Triple3& a, const Triple3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// The vector scaled to unit length; unchanged where its length is 0 or NaN.
inline Triple3 unit(const Triple3& v) {
  const double length = std::sqrt(inner(v, v));
  return length > 0 ? times(v, 1 / length) : v;
}

}  // namespace trueshade::oracle
