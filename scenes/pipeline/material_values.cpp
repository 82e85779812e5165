#include "scenes/pipeline/material_values.h"

#include <algorithm>

#include "core/fp_env.h"

namespace trueshade {

bool drawn_unlit(const Material& material, const Pipeline& pipeline) {
  const bool into_albedo = material.transparent && pipeline.transparency.mode == TransparencyMode::into_albedo;
  return material.unlit && shows_unlit(pipeline.light_model) && !into_albedo;
}

MaterialValues material_values(const Material& m, const Pipeline& pipeline) {
  const FpScope fp;
  const LightModel& model = pipeline.light_model;
  const bool metals = maps_metals(model), unlit = drawn_unlit(m, pipeline), lit = !unlit;
  const glm::vec3 &specular = m.specular_color, &emission = m.emission;
  return {.specular = {specular.r, specular.g, specular.b, metals ? shininess_of_roughness(m.roughness) : m.shininess},
          .emission = {emission.r, emission.g, emission.b},
          .metallic = metals ? m.metallic : 0.0f,
          .roughness = m.roughness,
          .occlusion_strength = m.occlusion_strength,
          .unlit = unlit,
          .specular_map = lit && takes_gloss(model) && m.specular_map.used(),
          .metallic_roughness_map = lit && metals && m.metallic_roughness_map.used(),
          .emission_map = lit && model.emission && m.emission_map.used(),
          .occlusion_map = lit && model.emission && m.occlusion_map.used()};
}

bool has_ambient_light(const Scene& scene, const LightModel& model) {
  const FpScope fp;
  return model.global_ambient != glm::vec3(0.0f) ||
         std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return is_ambient(light.type); });
}

}  // namespace trueshade
