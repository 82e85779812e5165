#include "scenes/pipeline/fit_lights.h"

#include "core/fp_env.h"
#include "scenes/lights_of_ours.h"

namespace trueshade {

void fit_lights_of_ours(Scene& scene, const LightModel& model) {
  const FpScope fp;
  const bool spreads = model.falloff == Falloff::inverse_square;
  if (!scene.lights_of_ours || spreads == scene.photometric) return;
  for (Light& light : scene.lights) {
    const double more = spread_light(light);
    light.color = glm::vec3(glm::dvec3(light.color) * (spreads ? more : 1.0 / more));
  }
}

}  // namespace trueshade
