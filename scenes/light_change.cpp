#include "scenes/light_change.h"

#include <algorithm>
#include <initializer_list>

#include "core/fp_env.h"

namespace trueshade {
namespace {

void stop(Scene& scene, uint32_t light, std::initializer_list<LightProperty> properties) {
  std::erase_if(scene.timeline.lights, [&](const LightMotion& motion) {
    return motion.light == light &&
           std::find(properties.begin(), properties.end(), motion.property) != properties.end();
  });
}

void replace_color(Scene& scene, uint32_t light, const glm::vec3& color) {
  stop(scene, light, {LightProperty::color, LightProperty::intensity});
  scene.lights[light].color = color;
}

void multiply_color(Scene& scene, uint32_t light, double factor) {
  const auto times = [factor](const glm::dvec4& value) { return glm::dvec4(glm::dvec3(value) * factor, value.w); };
  scene.lights[light].color = glm::vec3(times(glm::dvec4(scene.lights[light].color, 0.0)));
  for (LightMotion& motion : scene.timeline.lights) {
    if (motion.light != light || motion.property != LightProperty::color) continue;
    for (auto* values : {&motion.track.values, &motion.track.arriving, &motion.track.leaving})
      std::transform(values->begin(), values->end(), values->begin(), times);
  }
}

void replace_position(Scene& scene, uint32_t light, const glm::vec3& position) {
  stop(scene, light, {LightProperty::position});
  std::erase_if(scene.timeline.orbits, [light](const Orbit& orbit) { return orbit.light == light; });
  std::erase_if(scene.timeline.node_lights, [light](const NodeLight& hung) { return hung.light == light; });
  scene.lights[light].position = position;
}

}  // namespace

void change_light(Scene& scene, const LightChange& change) {
  const FpScope fp;
  if (change.light >= scene.lights.size()) return;
  if (change.color) replace_color(scene, change.light, *change.color);
  if (change.intensity) multiply_color(scene, change.light, *change.intensity);
  if (change.position) replace_position(scene, change.light, *change.position);
  if (change.on) return;
  replace_color(scene, change.light, glm::vec3(0.0f));
  stop(scene, change.light, {LightProperty::ambient});
  scene.lights[change.light].ambient = glm::vec3(0.0f);
}

}  // namespace trueshade
