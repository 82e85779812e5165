#pragma once
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

namespace trueshade::oracle {

using Real = long double;
using Vector = std::array<Real, 3>;

inline Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Vector vector_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// v / |v|; the zero vector stays.
inline Vector unit(const Vector& v) {
  const Real length = std::sqrt(dot(v, v));
  if (length == 0) return v;
  return {v[0] / length, v[1] / length, v[2] / length};
}

}  // namespace trueshade::oracle
