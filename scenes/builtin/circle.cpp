#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// After "TouchDesigner Deferred Lighting - Point Lights": lights on a circle, their colours from a ramp and noise,
// around a torus knot on a stage with a ring of balls.
namespace trueshade::builtin {
namespace {

constexpr uint32_t kCircleLights = 64, kCircleObjects = 26;

glm::dvec3 knot_point(double t) {  // the (2, 3) torus knot, t in turns
  const double a = 2.0 * kPi * t;
  const double r = 1.0 + 0.42 * cosine(3.0 * a);
  return {r * cosine(2.0 * a), 0.42 * sine(3.0 * a), r * sine(2.0 * a)};
}

/// A fluted tube along the knot.
SurfacePoint knot_surface(double u, double v) {
  const double step = 1.0 / 4096.0;
  const glm::dvec3 centre = knot_point(u);
  const glm::dvec3 along = unit(knot_point(u + step) - knot_point(u - step));
  const glm::dvec3 side = unit(cross(along, {0.0, 1.0, 0.0}));
  const glm::dvec3 up = cross(side, along);
  const double angle = 2.0 * kPi * v, flutes = 7.0 * angle + 2.0 * kPi * 24.0 * u;
  const double radius = 0.2 * (1.0 + 0.10 * cosine(flutes));
  const double slope = -0.2 * 0.10 * 7.0 * sine(flutes);  // d radius / d angle
  const glm::dvec3 outward = side * cosine(angle) + up * sine(angle);
  const glm::dvec3 around = up * cosine(angle) - side * sine(angle);
  return {centre + outward * radius, outward * radius - around * slope};
}

/// The ramp around the circle: amber, magenta, blue and back.
glm::dvec3 ramp(double turn) {
  const glm::dvec3 colors[] = {{1.0, 0.52, 0.16}, {1.0, 0.16, 0.50}, {0.16, 0.48, 1.0}};
  const double at = (turn - std::floor(turn)) * 3.0;
  const int first = int(at);
  return colors[first] + (colors[(first + 1) % 3] - colors[first]) * (at - first);
}

}  // namespace

Mesh knot_mesh() {
  Mesh mesh = torus_mesh(420, 49, knot_surface);
  mesh.name = "knot";
  return mesh;
}

Scene circle(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.016f, 0.014f, 0.028f, 1.0f};
  scene.materials = {{"stage", {0.46f, 0.46f, 0.48f, 1.0f}},
                     {"knot", {0.85f, 0.83f, 0.80f, 1.0f}},
                     {"ball", {0.72f, 0.72f, 0.74f, 1.0f}}};
  scene.meshes = {plane_mesh(28), knot_mesh(), sphere_mesh(14)};
  scene.instances.push_back({0, 0, placed({0.0, 0.0, 0.0}, {18.0, 1.0, 18.0})});
  scene.instances.push_back({1, 1, placed({0.0, 1.0, 0.0}, glm::dvec3(1.15))});
  const uint32_t balls = parameters.objects_or(kCircleObjects) - 1;
  for (uint32_t i = 1; i < balls; ++i) {
    const double angle = 2.0 * kPi * i / (balls - 1);
    const double radius = 0.22 + 0.10 * double(i % 3);
    scene.instances.push_back({2, 2, placed({2.8 * cosine(angle), radius, 2.8 * sine(angle)}, glm::dvec3(radius))});
  }

  Pcg32 random(parameters.seed, 6);
  const uint32_t lights = parameters.lights_or(kCircleLights);
  const double reach = parameters.reach(kCircleLights);
  for (uint32_t i = 0; i < lights; ++i) {  // the circle turns
    const double turn = double(i) / lights;
    const double noise = random.real();
    const glm::dvec3 at(3.7 * cosine(2.0 * kPi * turn), 0.8 + 1.2 * noise, 3.7 * sine(2.0 * kPi * turn));
    const Light light = point_light(at, ramp(turn + 0.62 + 0.12 * noise) * (0.12 + 0.14 * noise), 5.0 * reach);
    add_moving(scene, light, {3.7, 0.0, 0.0}, {0.0, 0.0, 3.7}, 16.0, turn);
  }
  scene.camera.eye = {0.0f, 3.4f, 6.6f};
  scene.camera.target = {0.0f, 0.55f, 0.0f};
  scene.camera.fov_y_rad = 0.75f;
  scene.camera.near = 0.1f;
  scene.camera.far = 60.0f;
  return scene;
}

}  // namespace trueshade::builtin
