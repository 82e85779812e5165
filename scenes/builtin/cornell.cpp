#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// The Cornell box (Goral and others, "Modeling the Interaction of Light Between Diffuse Surfaces", 1984): white floor,
// ceiling and back, a red and a green wall, two blocks. One warm lamp under the ceiling, the others coloured and
// drifting.
namespace trueshade::builtin {
namespace {

/// A wall of the box [-1, 1]^3: the plane mesh turned so that its normal (0, 1, 0) becomes `up` and its x axis `side`.
glm::mat4x3 wall(const glm::vec3& centre, const glm::vec3& side, const glm::vec3& up, const glm::vec3& front) {
  return glm::mat4x3(2.0f * side, up, 2.0f * front, centre);
}

void add_box(Scene& scene) {
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
  scene.instances.push_back({0, 0, wall(-y, x, y, z)});   // floor
  scene.instances.push_back({0, 0, wall(y, x, -y, -z)});  // ceiling
  scene.instances.push_back({0, 0, wall(-z, x, z, -y)});  // back
  scene.instances.push_back({0, 1, wall(-x, -y, x, z)});  // left
  scene.instances.push_back({0, 2, wall(x, y, -x, z)});   // right
}

}  // namespace

Scene cornell(const Parameters& parameters) {
  constexpr uint32_t kLights = 12;
  Scene scene;
  scene.clear = {0.0f, 0.0f, 0.0f, 1.0f};
  scene.materials = {{"white", {0.74f, 0.73f, 0.70f, 1.0f}},
                     {"red", {0.70f, 0.10f, 0.08f, 1.0f}},
                     {"green", {0.14f, 0.55f, 0.12f, 1.0f}}};
  scene.meshes = {plane_mesh(14), cube_mesh()};
  add_box(scene);
  scene.instances.push_back({1, 0, placed({0.36, -0.7, 0.32}, {0.6, 0.6, 0.6}, -0.29)});
  scene.instances.push_back({1, 0, placed({-0.34, -0.4, -0.30}, {0.6, 1.2, 0.6}, 0.31)});

  Pcg32 random(parameters.seed, 5), drift(parameters.seed, 25);
  const uint32_t lights = parameters.lights_or(kLights);
  const double reach = parameters.reach(kLights);
  for (uint32_t i = 0; i < lights; ++i) {
    if (i == 0) {
      scene.lights.push_back(point_light({0.0, 0.80, 0.05}, {0.78, 0.70, 0.56}, 3.2));
      continue;
    }
    if (i == 1) {  // beside the viewer, for the faces turned here
      scene.lights.push_back(point_light({0.7, 0.6, 2.6}, {0.5, 0.49, 0.52}, 6.0));
      continue;
    }
    const glm::dvec3 at{random.between(-0.88, 0.88), random.between(-0.85, 0.8), random.between(-0.7, 1.1)};
    const glm::dvec3 color = color_of_hue(0.381966 * i, 0.7) * random.between(0.28, 0.42);
    const double period = drift.between(5.0, 11.0);
    add_moving(scene, point_light(at, color, 1.25 * reach), {0.11, 0.0, 0.0}, {0.0, 0.08, 0.11}, period, drift.real());
  }
  scene.camera.eye = {0.0f, 0.0f, 3.55f};
  scene.camera.fov_y_rad = 0.72f;
  scene.camera.near = 0.1f;
  scene.camera.far = 20.0f;
  return scene;
}

}  // namespace trueshade::builtin
