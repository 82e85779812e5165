#include "scenes/files/lights_of_ours.h"

#include <algorithm>

#include "scenes/builtin/light_generators.h"
#include "scenes/scene_defaults.h"

namespace trueshade {

void add_lights_of_ours(Scene& scene) {
  const Bounds bounds = bounds_of(scene);
  const glm::vec3 colors[] = {{1.0f, 0.72f, 0.42f}, {1.0f, 0.35f, 0.45f}, {0.35f, 0.5f, 1.0f}, {0.5f, 1.0f, 0.9f}};
  LightRing ring;
  ring.count = 24;
  ring.centre = bounds.centre + glm::dvec3(0.0, 0.6 * bounds.radius, 0.0);
  ring.radius = 1.3 * bounds.radius;
  ring.colors = colors;
  ring.intensity = scene.photometric ? std::min(0.3 * (bounds.radius * bounds.radius), 1e17) : 0.3;
  ring.range = float(3.0 * bounds.radius);
  ring.attenuation = {1.0f, 0.0f, float(1.0 / (bounds.radius * bounds.radius))};
  add_ring(scene, ring);
  scene.clear = {0.02f, 0.02f, 0.03f, 1.0f};
  scene.lights_of_ours = true;
}

}  // namespace trueshade
