#pragma once
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Whether a material shows its colour as it is: Material::unlit where the light model can do that, but for surfaces
/// that are blended into the albedo, whose colour lights multiply.
bool drawn_unlit(const Material& material, const Pipeline& pipeline);

/// What a pipeline reads of a material beside base colour and normal map (docs/arithmetic.md section 7).
struct MaterialValues {
  float specular[4];  ///< colour and shininess
  float emission[3];
  float metallic, roughness;  ///< metallic is 0 where the model maps no metals
  float occlusion_strength;
  bool unlit;  ///< drawn_unlit(): no other field but the shininess counts
  // Which maps are read, each multiplied by the value above.
  bool specular_map, metallic_roughness_map, emission_map, occlusion_map;
};
MaterialValues material_values(const Material& material, const Pipeline& pipeline);

/// Whether a light model reads any of them.
constexpr bool reads_material_values(const LightModel& model) {
  return model.emission || reads_specular_plane(model) || maps_metals(model);
}

/// Whether light that occlusion maps hold off may arrive: the model's or a light's ambient light.
bool has_ambient_light(const Scene& scene, const LightModel& model);

}  // namespace trueshade
