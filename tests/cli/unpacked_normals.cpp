// The bounds of unpacked normals: what shaders compute from the same codes, in floats and in several legal ways, is
// within the reading bound; and whatever direction is packed into either neighbouring code is within the packing bound.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cli/capture/unpacking.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

struct FloatNormal {
  float v[3];
};

/// Ways to compute that GLSL allows: a product and a sum contracted or not, a root and a quotient or their reciprocals.
enum class Way { plain, contracted, reciprocal };

float dot3(const float a[3], Way way) {
  if (way == Way::contracted) return std::fma(a[0], a[0], std::fma(a[1], a[1], a[2] * a[2]));
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

float doubled(float c, Way way) { return way == Way::contracted ? std::fma(c, 2.0f, -1.0f) : c * 2.0f - 1.0f; }

FloatNormal octahedral_in_floats(float x, float y, Way way) {
  float v[3] = {x, y,
                way == Way::reciprocal ? 1.0f - (std::fabs(x) + std::fabs(y)) : 1.0f - std::fabs(x) - std::fabs(y)};
  if (v[2] < 0) {
    const float folded = (1.0f - std::fabs(y)) * (x >= 0 ? 1.0f : -1.0f);
    v[1] = (1.0f - std::fabs(x)) * (y >= 0 ? 1.0f : -1.0f);
    v[0] = folded;
  }
  const float length = std::sqrt(dot3(v, way)), inverse = 1.0f / length;
  FloatNormal n{};
  for (int k = 0; k < 3; ++k) n.v[k] = way == Way::plain ? v[k] / length : v[k] * inverse;
  return n;
}

FloatNormal spheremap_in_floats(float x, float y, Way way) {
  const float f[] = {way == Way::contracted ? std::fma(x, 4.0f, -2.0f) : x * 4.0f - 2.0f,
                     way == Way::contracted ? std::fma(y, 4.0f, -2.0f) : y * 4.0f - 2.0f};
  const float f2 = way == Way::contracted ? std::fma(f[0], f[0], f[1] * f[1]) : f[0] * f[0] + f[1] * f[1];
  const float root = std::sqrt(std::max(0.0f, 1.0f - (way == Way::reciprocal ? f2 * 0.25f : f2 / 4.0f)));
  return {{f[0] * root, f[1] * root, 1.0f - f2 / 2.0f}};
}

/// A code as a shader may read it: divided, or by a reciprocal.
float fetched(int code, int largest, Way way) {
  return way == Way::reciprocal ? float(code) * (1.0f / float(largest)) : float(code) / float(largest);
}

PackedNumber number_of(int code, int largest) {
  const double c = double(code) / largest;
  return {c, 1.0 / largest, 2.5 * 0x1p-23 * c};
}

/// How much of its reading bound a float unpacking uses.
double used(const UnpackedVector& exact, const FloatNormal& n) {
  double most = 0;
  for (size_t k = 0; k < 3; ++k)
    most = std::max(most, std::fabs(double(float(exact.value[k])) - double(n.v[k])) / exact.reading_error);
  return most;
}

double off(const UnpackedVector& exact, const double n[3]) {
  double most = 0;
  for (size_t k = 0; k < 3; ++k) most = std::max(most, std::fabs(double(float(exact.value[k])) - n[k]));
  return most;
}

/// Directions all over the sphere, axes and their neighbourhoods among them.
template <typename Job>
void each_direction(Job job) {
  constexpr int kSteps = 61;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double a = 3.14159265358979 * i / kSteps, b = 6.28318530717959 * j / (4 * kSteps);
      job(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    }
}

}  // namespace

TEST_CASE(
    "Octahedral codes of 8 bits, all of them, unpacked in floats are within the reading bound, and use some of it") {
  double most = 0;
  for (int x = 0; x < 256; ++x)
    for (int y = 0; y < 256; ++y) {
      const auto exact = unpacked_octahedral(signed_number(number_of(x, 255)), signed_number(number_of(y, 255)));
      REQUIRE(exact.has_value());
      for (const Way way : {Way::plain, Way::contracted, Way::reciprocal})
        most = std::max(most, used(*exact, octahedral_in_floats(doubled(fetched(x, 255, way), way),
                                                                doubled(fetched(y, 255, way), way), way)));
    }
  CHECK(most <= 1);
  CHECK(most > 0.02);
}

TEST_CASE("Spheremap codes of 8 bits, all that a direction is packed to, are within the reading bound") {
  double most = 0;
  int read = 0;
  for (int x = 0; x < 256; ++x)
    for (int y = 0; y < 256; ++y) {
      const auto exact = unpacked_spheremap(number_of(x, 255), number_of(y, 255));
      if (!exact) continue;
      ++read;
      for (const Way way : {Way::plain, Way::contracted, Way::reciprocal})
        most = std::max(most, used(*exact, spheremap_in_floats(fetched(x, 255, way), fetched(y, 255, way), way)));
    }
  CHECK(read > 45000);  // the disc's share of the square: pi / 4 of 65536 is 51472
  CHECK(read < 54000);
  CHECK(most <= 1);
  CHECK(most > 0.02);
}

TEST_CASE(
    "A direction packed into either neighbouring code is within the packing bound, and steps are not far below it") {
  double most_octahedral = 0, most_sphere = 0, most_components = 0;
  each_direction([&](double x, double y, double z) {
    const double n[] = {x, y, z}, sum = std::fabs(x) + std::fabs(y) + std::fabs(z);
    double e[] = {x / sum, y / sum};
    if (z < 0) {
      const double folded = (1 - std::fabs(e[1])) * (e[0] >= 0 ? 1 : -1);
      e[1] = (1 - std::fabs(e[0])) * (e[1] >= 0 ? 1 : -1);
      e[0] = folded;
    }
    const double f = std::sqrt(std::max(0.0, 8 * z + 8));
    for (int corner = 0; corner < 4; ++corner) {
      const auto code = [&](double c, int up) { return std::clamp(int(std::floor(c * 255)) + up, 0, 255); };
      const auto octahedral = unpacked_octahedral(signed_number(number_of(code(e[0] * 0.5 + 0.5, corner & 1), 255)),
                                                  signed_number(number_of(code(e[1] * 0.5 + 0.5, corner >> 1), 255)));
      REQUIRE(octahedral.has_value());
      most_octahedral = std::max(most_octahedral, off(*octahedral, n) / octahedral->packing_error);
      std::array<PackedNumber, 3> c;
      for (size_t k = 0; k < 3; ++k) c[k] = signed_number(number_of(code(n[k] * 0.5 + 0.5, corner & 1), 255));
      const UnpackedVector components = unpacked_components(c);
      most_components = std::max(most_components, off(components, n) / components.packing_error);
      if (z < -0.9) continue;
      const auto sphere = unpacked_spheremap(number_of(code(x / f + 0.5, corner & 1), 255),
                                             number_of(code(y / f + 0.5, corner >> 1), 255));
      REQUIRE(sphere.has_value());
      most_sphere = std::max(most_sphere, off(*sphere, n) / sphere->packing_error);
    }
  });
  CHECK(most_octahedral <= 1);
  CHECK(most_octahedral > 0.3);
  CHECK(most_components <= 1);
  CHECK(most_components > 0.9);
  CHECK(most_sphere <= 1);
  CHECK(most_sphere > 0.2);
}

TEST_CASE("Numbers that nothing is packed to are none") {
  CHECK_FALSE(unpacked_octahedral({1.01, 0, 0}, {0, 0, 0}).has_value());
  CHECK_FALSE(unpacked_octahedral({NAN, 0, 0}, {0, 0, 0}).has_value());
  CHECK_FALSE(unpacked_spheremap({0.05, 0, 0}, {0.05, 0, 0}).has_value());
  CHECK_FALSE(unpacked_spheremap({NAN, 0, 0}, {0.5, 0, 0}).has_value());
}

}  // namespace trueshade
