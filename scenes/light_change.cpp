#include "scenes/light_change.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "core/fp_env.h"
#include "scenes/light_fields.h"

namespace trueshade {
namespace {

/// A changed light's properties that stop moving, and the color tracks that the light keeps.
struct ChangedLight {
  bool color_stops = false, ambient_stops = false, position_stops = false;
  std::vector<Track*> colors{};

  bool stops(LightProperty property) const {
    return (color_stops && (property == LightProperty::color || property == LightProperty::intensity)) ||
           (ambient_stops && property == LightProperty::ambient) ||
           (position_stops && property == LightProperty::position);
  }
};
using ChangedLights = std::unordered_map<uint32_t, ChangedLight>;

ChangedLights changed_lights(const Scene& scene, std::span<const LightChange> changes) {
  ChangedLights changed;
  for (const LightChange& change : changes) {
    if (change.light >= scene.lights.size()) continue;
    ChangedLight& light = changed[change.light];
    light.color_stops = light.color_stops || change.color || !change.on;
    light.ambient_stops = light.ambient_stops || !change.on;
    light.position_stops = light.position_stops || change.position;
  }
  return changed;
}

void stop(Timeline& timeline, const ChangedLights& changed) {
  const auto stops_there = [&changed](const auto& moving) {
    const auto found = changed.find(moving.light);
    return found != changed.end() && found->second.position_stops;
  };
  std::erase_if(timeline.orbits, stops_there);
  std::erase_if(timeline.node_lights, stops_there);
  std::erase_if(timeline.lights, [&changed](const LightMotion& motion) {
    const auto found = changed.find(motion.light);
    return found != changed.end() && found->second.stops(motion.property);
  });
}

void multiply_color(Light& light, const std::vector<Track*>& tracks, double factor) {
  const auto times = [factor](const glm::dvec4& value) { return glm::dvec4(glm::dvec3(value) * factor, value.w); };
  light.color = glm::vec3(times(glm::dvec4(light.color, 0.0)));
  for (Track* const track : tracks)
    for (auto* values : {&track->values, &track->arriving, &track->leaving})
      std::transform(values->begin(), values->end(), values->begin(), times);
}

}  // namespace

void change_lights(Scene& scene, std::span<const LightChange> changes) {
  const FpScope fp;
  ChangedLights changed = changed_lights(scene, changes);
  stop(scene.timeline, changed);
  for (LightMotion& motion : scene.timeline.lights)
    if (const auto found = changed.find(motion.light); found != changed.end())
      if (motion.property == LightProperty::color) found->second.colors.push_back(&motion.track);
  for (const LightChange& change : changes) {
    if (change.light >= scene.lights.size()) continue;
    Light& light = scene.lights[change.light];
    if (change.color) light.color = *change.color;
    if (change.intensity) multiply_color(light, changed[change.light].colors, *change.intensity);
    if (change.position) light.position = *change.position;
    if (!change.on) light.color = light.ambient = glm::vec3(0.0f);
  }
}

}  // namespace trueshade
