#include "scenes/builtin/builtin_scenes.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "scenes/trig.h"

// One sphere of 20,000 faces inside a shell of lights that overlap strongly: the worst case for culling by tiles, since
// a pixel is lit by a third of all lights.
namespace trueshade::builtin {

Scene sphere(const Parameters& parameters) {
  constexpr uint32_t kLights = 100;
  Scene scene;
  scene.clear = {0.0f, 0.0f, 0.0f, 1.0f};
  scene.materials.push_back({"plaster", {0.82f, 0.82f, 0.84f, 1.0f}});
  scene.meshes.push_back(sphere_mesh(50));
  scene.instances.push_back({0, 0, placed({0.0, 0.0, 0.0}, glm::dvec3(2.0))});

  Pcg32 random(parameters.seed, 3);
  const uint32_t lights = parameters.lights_or(kLights);
  const double reach = parameters.reach(kLights);
  for (uint32_t i = 0; i < lights; ++i) {
    // Evenly over the directions by the golden angle, at changing heights above the sphere.
    const double y = 1.0 - (2.0 * i + 1.0) / lights;
    const double turn_rad = 2.399963229728653 * i;
    const double ring = std::sqrt(1.0 - y * y);
    const double height = (0.9 + 1.6 * random.real()) * reach;
    const glm::dvec3 direction(ring * cosine(turn_rad), y, ring * sine(turn_rad));
    const double hue = 0.55 + 0.35 * direction.x + 0.2 * direction.y + 0.08 * random.real();
    // Every sixth is close and bright, so that the ball has spots; the others fill.
    const bool is_spot = i % 6 == 0;
    const glm::dvec3 color = color_of_hue(hue, is_spot ? 0.35 : 0.85) * (is_spot ? 0.75 : random.between(0.11, 0.21));
    const glm::dvec3 at = direction * (2.0 + (is_spot ? 0.3 * reach : height));
    const glm::dvec3 across =
        glm::dvec3(-at.z, 0.0, at.x) * (is_spot ? 1.0 : -1.0);  // the close ones against the others
    add_moving(scene, point_light(at, color, (is_spot ? 3.0 : 6.0) * reach), {at.x, 0.0, at.z}, across,
               is_spot ? 24.0 : 15.0, 0.0);
  }
  scene.camera.eye = {0.0f, 1.2f, 5.4f};
  scene.camera.fov_y_rad = 0.85f;
  scene.camera.near = 0.1f;
  scene.camera.far = 50.0f;
  return scene;
}

}  // namespace trueshade::builtin
