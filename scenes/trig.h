#pragma once
#include <cmath>
#include <glm/vec3.hpp>

// Angles and unit vectors by IEEE operations alone: libm's sin and cos differ between processors of one machine type,
// and a scene made with them would have one hash per library. docs/arithmetic.md, section 1;
// tests/scenes/camera_and_trig.cpp.
namespace trueshade {

inline constexpr double kPi = 3.14159265358979323846;

namespace detail {

/// x = quadrant * pi/2 + rest, |rest| <= pi/4 or a little more; quadrant in 0..3.
struct ReducedAngle {
  double rest;
  int quadrant;
};

inline ReducedAngle reduced(double x_rad) {
  // pi/2 in two parts; the first has 33 bits, so n * kHigh is exact for every |x| <= 1e6.
  constexpr double kHigh = 1.5707963267341256, kLow = 6.077100506506192e-11;
  const double n = std::round(x_rad * (2.0 / kPi));
  const double rest = (x_rad - n * kHigh) - n * kLow;
  return {rest, int(static_cast<long long>(n) & 3)};
}

// Taylor series in z = r^2, Horner from the highest term. The factorials are exact in double.
inline double sin_near_0(double r) {
  const double z = r * r;
  double p = 1.0 / 355687428096000.0;
  p = p * z - 1.0 / 1307674368000.0;
  p = p * z + 1.0 / 6227020800.0;
  p = p * z - 1.0 / 39916800.0;
  p = p * z + 1.0 / 362880.0;
  p = p * z - 1.0 / 5040.0;
  p = p * z + 1.0 / 120.0;
  p = p * z - 1.0 / 6.0;
  p = p * z + 1.0;
  return p * r;
}

inline double cos_near_0(double r) {
  const double z = r * r;
  double p = 1.0 / 20922789888000.0;
  p = p * z - 1.0 / 87178291200.0;
  p = p * z + 1.0 / 479001600.0;
  p = p * z - 1.0 / 3628800.0;
  p = p * z + 1.0 / 40320.0;
  p = p * z - 1.0 / 720.0;
  p = p * z + 1.0 / 24.0;
  p = p * z - 0.5;
  p = p * z + 1.0;
  return p;
}

}  // namespace detail

/// Sine and cosine of an angle in radians, |x| <= 1e6; absolute error below 2^-51.
inline double sine(double x_rad) {
  const detail::ReducedAngle a = detail::reduced(x_rad);
  const double magnitude = a.quadrant & 1 ? detail::cos_near_0(a.rest) : detail::sin_near_0(a.rest);
  return a.quadrant & 2 ? -magnitude : magnitude;
}

inline double cosine(double x_rad) {
  const detail::ReducedAngle a = detail::reduced(x_rad);
  const double magnitude = a.quadrant & 1 ? detail::sin_near_0(a.rest) : detail::cos_near_0(a.rest);
  return a.quadrant == 1 || a.quadrant == 2 ? -magnitude : magnitude;
}

/// sine / cosine.
inline double tangent(double x_rad) { return sine(x_rad) / cosine(x_rad); }

/// The angle from 0 to pi/2 whose sine and cosine these are, up to a common factor near 1. Newton's steps for
/// s cos a - c sin a = 0 triple the digits each.
inline double angle_of(double s, double c) {
  double a = s;
  for (int step = 0; step < 4; ++step) a = a + (s * cosine(a) - c * sine(a));
  return a;
}

/// v * (1 / |v|); a zero vector stays zero.
inline glm::dvec3 unit(const glm::dvec3& v) {
  const double length2 = (v.x * v.x + v.y * v.y) + v.z * v.z;
  return length2 > 0.0 ? v * (1.0 / std::sqrt(length2)) : v;
}

inline double dot(const glm::dvec3& a, const glm::dvec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

inline glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace trueshade
