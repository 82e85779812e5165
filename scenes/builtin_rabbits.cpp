#include "scenes/builtin_scenes.h"
#include "scenes/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

namespace trueshade::builtin {
namespace {

constexpr uint32_t kLights = 100, kObjects = 125;

}  // namespace

Mesh rabbit_mesh() {
  Mesh mesh = torus_mesh(200, 100, [](double u, double v) -> SurfacePoint {
    const double a = 2.0 * kPi * u, b = -2.0 * kPi * v;
    const glm::dvec3 n(cosine(a) * cosine(b), sine(b), sine(a) * cosine(b));
    return {glm::dvec3(0.45 * cosine(a), 0.45, 0.45 * sine(a)) + 0.3 * n, n};
  });
  mesh.name = "rabbit";
  return mesh;
}

Scene rabbits(const Parameters& parameters) {
  Scene scene;
  scene.clear = {0.01f, 0.012f, 0.02f, 1.0f};
  scene.materials = {{"snow", {0.86f, 0.85f, 0.83f, 1.0f}}, {"sand", {0.76f, 0.62f, 0.46f, 1.0f}},
                     {"slate", {0.50f, 0.52f, 0.58f, 1.0f}}, {"clay", {0.66f, 0.42f, 0.32f, 1.0f}}};
  scene.meshes = {rabbit_mesh()};
  Pcg32 random(parameters.seed, 2);
  const uint32_t objects = parameters.objects_or(kObjects);
  uint32_t columns = 1;
  while (columns * columns < objects) ++columns;
  const double pitch = 1.25, half = 0.5 * pitch * double(columns);
  for (uint32_t i = 0; i < objects; ++i) {
    const glm::dvec3 at((double(i % columns) + 0.5) * pitch - half, 0.0, (double(i / columns) + 0.5) * pitch - half);
    scene.instances.push_back({0, random.below(4), placed(at, glm::dvec3(1.0), 2.0 * kPi * random.real())});
  }
  const uint32_t lights = parameters.lights_or(kLights);
  const double reach = parameters.reach(kLights);
  for (uint32_t i = 0; i < lights; ++i) {
    const glm::dvec3 at(random.between(-half, half), (0.9 + 0.9 * random.real()) * reach, random.between(-half, half));
    scene.lights.push_back(point_light(at, color_of_hue(random.real(), 0.6) * random.between(0.5, 0.8), 3.0 * reach));
  }
  scene.camera.eye = glm::vec3(glm::dvec3(0.0, 0.75, 1.35) * half);
  scene.camera.target = glm::vec3(glm::dvec3(0.0, 0.02, 0.1) * half);
  scene.camera.fov_y_rad = 0.8f;
  scene.camera.near = 0.1f;
  scene.camera.far = float(10.0 * half);
  return scene;
}

}  // namespace trueshade::builtin
