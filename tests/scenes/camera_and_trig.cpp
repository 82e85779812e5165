#include <cmath>

#include "scenes/camera.h"
#include "scenes/trig.h"
#include "tests/catch.hpp"

// libm is no part of a scene, but a good judge: glibc's sine is within 1 ulp.
namespace trueshade {
namespace {

TEST_CASE("sine and cosine are within 2^-51 of libm over a million angles up to 1e6") {
  double worst = 0.0;
  for (int i = -500000; i <= 500000; ++i) {
    const double x = i * (i % 3 == 0 ? 1.999999 : i % 3 == 1 ? 1e-5 : 0.00123);
    worst = std::max({worst, std::fabs(sine(x) - std::sin(x)), std::fabs(cosine(x) - std::cos(x))});
  }
  // 2 ulp of values in [1/2, 1), and for large angles what is left of pi/2 after its 86 bits.
  CHECK(worst < 0x1p-51);
}

TEST_CASE("tangent of half a field of view is within 8 ulp of libm") {
  for (int i = 1; i < 100000; ++i) {
    const double x = i * (0.5 * kPi / 100001.0), t = std::tan(x);
    const double ulp = std::nextafter(t, INFINITY) - t;
    REQUIRE(std::fabs(tangent(x) - t) <= 8.0 * ulp);
  }
}

TEST_CASE("multiples of a quarter turn have their signs") {
  CHECK(sine(0.0) == 0.0);
  CHECK(cosine(0.0) == 1.0);
  CHECK(sine(0.5 * kPi) == 1.0);
  CHECK(cosine(kPi) == -1.0);
  CHECK(sine(-0.5 * kPi) == -1.0);
  CHECK(sine(2.5 * kPi) == 1.0);
}

TEST_CASE("a zero vector stays zero and others get length 1 within 2 ulp") {
  CHECK(unit(glm::dvec3(0.0)) == glm::dvec3(0.0));
  const glm::dvec3 v = unit({3.0, -4.0, 12.0});
  CHECK(std::fabs(dot(v, v) - 1.0) < 0x1p-51);
}

glm::dvec3 ndc(const Matrix4& m, const glm::dvec3& p) {
  double c[4];
  for (size_t r = 0; r < 4; ++r) c[r] = ((m[r] * p.x + m[4 + r] * p.y) + m[8 + r] * p.z) + m[12 + r];
  return {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
}

TEST_CASE("a camera sees its target in the middle and its near and far planes at the ends of depth") {
  Camera camera;
  camera.eye = {1.0f, 2.0f, 3.0f};
  camera.target = {-2.0f, 0.5f, -4.0f};
  camera.near = 0.5f;
  camera.far = 80.0f;
  const glm::dvec3 eye(camera.eye), forward = unit(glm::dvec3(camera.target) - eye);
  const Matrix4 gl = clip_from_world(camera, 1.5), d3d = clip_from_world(camera, 1.5, ClipRange::zero_to_one);
  CHECK(std::fabs(ndc(gl, glm::dvec3(camera.target)).x) < 1e-14);
  CHECK(std::fabs(ndc(gl, glm::dvec3(camera.target)).y) < 1e-14);
  CHECK(ndc(gl, eye + forward * 0.5).z == Approx(-1.0).epsilon(1e-12));
  CHECK(ndc(gl, eye + forward * 80.0).z == Approx(1.0).epsilon(1e-12));
  CHECK(std::fabs(ndc(d3d, eye + forward * 0.5).z) < 1e-12);
  CHECK(ndc(d3d, eye + forward * 80.0).z == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("the field of view spans the image along its own axis") {
  Camera camera;
  camera.eye = {0.0f, 0.0f, 0.0f};
  camera.target = {0.0f, 0.0f, -1.0f};
  camera.fov_y_rad = 0.9f;
  const double edge = std::tan(0.45f);
  CHECK(ndc(clip_from_world(camera, 2.0), {0.0, edge, -1.0}).y == Approx(1.0).epsilon(1e-6));
  CHECK(ndc(clip_from_world(camera, 2.0), {2.0 * edge, 0.0, -1.0}).x == Approx(1.0).epsilon(1e-6));
  camera.fov_x_rad = 0.9f;
  CHECK(ndc(clip_from_world(camera, 2.0), {edge, 0.0, -1.0}).x == Approx(1.0).epsilon(1e-6));
  CHECK(ndc(clip_from_world(camera, 2.0), {0.0, 0.5 * edge, -1.0}).y == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("an engine's matrix is taken as it is") {
  Camera camera;
  camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*camera.clip_from_world)[i] = 0.1f * float(i);
  const Matrix4 m = clip_from_world(camera, 3.0);
  for (size_t i = 0; i < 16; ++i) CHECK(m[i] == double(0.1f * float(i)));
}

}  // namespace
}  // namespace trueshade
