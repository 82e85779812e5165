#include "view/camera_controls.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/catch.hpp"

namespace trueshade::viewer {
namespace {

constexpr double kPi = 3.14159265358979323846;

Camera level_camera() {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 0};
  camera.up = {0, 1, 0};
  return camera;
}

bool near(const glm::vec3& a, const glm::vec3& b, float far = 1e-4f) { return glm::length(a - b) < far; }

glm::vec3 direction(const Camera& camera) { return glm::normalize(camera.target - camera.eye); }

TEST_CASE("A camera that nobody moves is the camera it was made of") {
  Camera camera = level_camera();
  camera.eye = {3, -2, 7};
  camera.target = {-1, 4, 0.5f};
  camera.fov_x_rad = 1.1f;
  const Camera same = CameraControls(camera, 10.0).camera();
  CHECK(near(same.eye, camera.eye));
  CHECK(near(same.target, camera.target));
  CHECK(same.fov_x_rad == camera.fov_x_rad);
  CHECK(same.near == camera.near);
}

TEST_CASE("Turning a quarter to the right from -z looks along +x, and the eye stays") {
  CameraControls controls(level_camera(), 10.0);
  controls.step({.turn = {kPi / 2, 0.0}}, 0.01);
  CHECK(near(direction(controls.camera()), {1, 0, 0}));
  CHECK(near(controls.camera().eye, {0, 0, 5}));
  controls.step({.turn = {0.0, kPi / 6}}, 0.01);
  CHECK(controls.camera().target.y > 0.0f);
  CHECK(direction(controls.camera()).y == Approx(0.5).margin(1e-5));  // sin 30 degrees
}

TEST_CASE("The view never comes nearer to the vertical than a degree") {
  CameraControls controls(level_camera(), 10.0);
  for (int i = 0; i < 50; ++i) controls.step({.turn = {0.1, 1.0}}, 0.01);
  CHECK(double(direction(controls.camera()).y) == Approx(std::cos(kPi / 180.0)).margin(1e-6));
  for (int i = 0; i < 50; ++i) controls.step({.orbit = {0.0, 1.0}}, 0.01);
  CHECK(double(direction(controls.camera()).y) == Approx(-std::cos(kPi / 180.0)).margin(1e-6));
}

TEST_CASE("Orbiting keeps what is looked at and its distance") {
  CameraControls controls(level_camera(), 10.0);
  controls.step({.orbit = {kPi / 2, 0.0}}, 0.01);
  CHECK(near(controls.camera().target, {0, 0, 0}));
  CHECK(near(controls.camera().eye, {5, 0, 0}));
  controls.step({.orbit = {0.3, 0.4}}, 0.01);
  CHECK(near(controls.camera().target, {0, 0, 0}));
  CHECK(glm::length(controls.camera().eye) == Approx(5.0).margin(1e-4));
  controls.step({.nearer = 2.0}, 0.01);
  CHECK(glm::length(controls.camera().eye) == Approx(5.0 * 0.81).margin(1e-4));
}

TEST_CASE("Flight at full speed covers speed times time, whatever the length of the steps, and ends soon") {
  for (const double step : {0.001, 0.016, 0.1}) {
    CameraControls controls(level_camera(), 8.0);  // 2 units a second
    for (double t = 0.0; t < 1.0 - 1e-9; t += step) controls.step({.fly = {0, 0, 1}}, step);
    const float begin = controls.camera().eye.z;
    for (double t = 0.0; t < 1.0 - 1e-9; t += step) controls.step({.fly = {0, 0, 1}}, step);
    INFO(step);
    CHECK(double(begin - controls.camera().eye.z) == Approx(2.0).epsilon(0.01));
    for (double t = 0.0; t < 0.5; t += step) controls.step({}, step);
    CHECK_FALSE(controls.flies());
  }
}

TEST_CASE("Up and right are those of the camera, and pace and wheel change the speed") {
  CameraControls controls(level_camera(), 8.0);
  controls.change_speed(2.0);
  CHECK(controls.speed() == Approx(2.0 * 1.44));
  for (int i = 0; i < 1000; ++i) controls.step({.fly = {1, 1, 0}, .pace = 4.0}, 0.001);
  const glm::vec3 eye = controls.camera().eye;
  CHECK(eye.x == Approx(eye.y));
  CHECK(eye.x > 8.0f);
  CHECK(eye.z == Approx(5.0f));
}

TEST_CASE("Speed and field of view stay within bounds, whatever is asked for") {
  CameraControls controls(level_camera(), 8.0);
  for (int i = 0; i < 100; ++i) controls.change_speed(100.0);
  CHECK(controls.speed() == Approx(8000.0));
  for (int i = 0; i < 100; ++i) controls.change_speed(-100.0);
  CHECK(controls.speed() == Approx(8e-6));
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  for (const double asked : {-1.0, 0.0, 200.0}) {
    controls.set_field_of_view(asked * kDegree);
    CHECK(controls.field_of_view() == Approx((asked > 0.0 ? 179.9 : 0.1) * kDegree));
  }
}

TEST_CASE("A camera of a matrix becomes one with a lens that sees the same") {
  Camera camera = level_camera();
  camera.fov_y_rad = 0.9f;
  Camera matrix;
  matrix.eye = camera.eye;
  matrix.clip_from_world.emplace();
  const Matrix4 clip = clip_from_world(camera, 1.5);
  for (size_t i = 0; i < 16; ++i) (*matrix.clip_from_world)[i] = float(clip[i]);
  const Camera lens = CameraControls(matrix, 5.0).camera();
  CHECK_FALSE(lens.clip_from_world);
  CHECK(near(direction(lens), {0, 0, -1}));
  CHECK(lens.fov_y_rad == Approx(0.9f).margin(1e-5));
  CHECK(near(lens.up, {0, 1, 0}));
}

TEST_CASE("A parallel projection becomes a camera of a usual angle") {
  Camera matrix;
  matrix.clip_from_world = std::array<float, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, 1};
  const Camera lens = CameraControls(matrix, 5.0).camera();
  CHECK(lens.fov_y_rad == 0.8f);
  CHECK(std::isfinite(lens.target.z));
}

TEST_CASE("Looking at a point puts it in the middle, and a point that is no place is passed over") {
  CameraControls controls(level_camera(), 10.0);
  controls.set_pivot({4, 3, 5});
  CHECK(near(controls.camera().target, {4, 3, 5}));
  controls.set_pivot({NAN, 0, 0});
  CHECK(near(controls.camera().target, {4, 3, 5}));
}

}  // namespace
}  // namespace trueshade::viewer
