#include "scenes/pipeline/fit_lights.h"

#include <algorithm>
#include <span>

#include "core/fp_env.h"
#include "scenes/json/json_value.h"
#include "scenes/lights_of_ours.h"
#include "scenes/pipeline/shipped_models.h"
#include "scenes/trig.h"

namespace trueshade {

LightFit fit_of(const Pipeline& pipeline) {
  const LightProgram& program = pipeline.light_program;
  if (program.used() && names_shipped_model(program.file)) return {true, true};
  return {pipeline.light_model.falloff == Falloff::inverse_square, false};
}

void fit_lights_of_ours(Scene& scene, const Pipeline& pipeline) {
  const FpScope fp;
  const LightFit fit = fit_of(pipeline), made_for{scene.photometric, false};
  if (!scene.lights_of_ours || fit == made_for) return;
  const size_t ours = std::min(scene.lights.size(), kLightsOfOurs);
  for (Light& light : std::span(scene.lights).last(ours)) {
    double gain = fit.divides_pi && !is_ambient(light.type) ? kPi : 1.0;
    if (fit.spreads != made_for.spreads) gain = fit.spreads ? gain * spread_light(light) : gain / spread_light(light);
    for (int c = 0; c < 3; ++c) light.color[c] = float(std::min(double(light.color[c]) * gain, double(json::kLargest)));
  }
}

}  // namespace trueshade
