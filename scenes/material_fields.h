#pragma once
#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <variant>

#include "scenes/scene.h"

// The fields of a material but its name and its maps, a row each. What reads, writes, checks or hashes materials visits
// the rows: scene files and exports of glTF, `--resolved`.
namespace trueshade {

/// Where scene_hash() has a field.
enum class MaterialHash : uint8_t {
  first,        ///< of all materials
  gloss,        ///< of materials of which a field of this part is not its default
  maps,         ///< of all materials of scenes that have a map or a mask
  transparent,  ///< a mark
  newer,        ///< of materials of which a field of this part is not its default, or that have one of the newer maps
  later         ///< behind a mark, of materials of which a field of this part is not its default
};

struct MaterialField {
  std::string_view key;     ///< in scene files and exported ones
  std::string_view member;  ///< in resolved scenes
  std::variant<float Material::*, glm::vec3 Material::*, glm::vec4 Material::*, bool Material::*> at;
  double least, most;  ///< of each number; alpha is in [0, 1]
  bool integer;        ///< the number is one
  MaterialHash hash;
};

inline constexpr MaterialField kMaterialFields[] = {
    {"color", "base_color", &Material::base_color, 0.0, 1e18, false, MaterialHash::first},
    {"specular_color", "specular_color", &Material::specular_color, 0.0, 1e18, false, MaterialHash::gloss},
    {"shininess", "shininess", &Material::shininess, 0.0, 8192.0, true, MaterialHash::gloss},
    {"emission", "emission", &Material::emission, 0.0, 1e18, false, MaterialHash::gloss},
    {"metallic", "metallic", &Material::metallic, 0.0, 1.0, false, MaterialHash::gloss},
    {"roughness", "roughness", &Material::roughness, 0.0, 1.0, false, MaterialHash::gloss},
    {"normal_scale", "normal_scale", &Material::normal_scale, -1000.0, 1000.0, false, MaterialHash::maps},
    {"alpha_cutoff", "alpha_cutoff", &Material::alpha_cutoff, 0.0, 1.0, false, MaterialHash::maps},
    {"transparent", "transparent", &Material::transparent, 0.0, 1.0, false, MaterialHash::transparent},
    {"occlusion_strength", "occlusion_strength", &Material::occlusion_strength, 0.0, 1.0, false, MaterialHash::newer},
    {"unlit", "unlit", &Material::unlit, 0.0, 1.0, false, MaterialHash::newer},
    {"double_sided", "double_sided", &Material::double_sided, 0.0, 1.0, false, MaterialHash::newer}};

/// Calls `visit(row, value)` for each field of a material in the order of the rows; a value is a float, a glm::vec3, a
/// glm::vec4 or a bool, const where the material is.
template <class AnyMaterial, class Visit>
void visit_fields(AnyMaterial& material, const Visit& visit) {
  for (const MaterialField& row : kMaterialFields)
    std::visit([&](auto member) { visit(row, material.*member); }, row.at);
}

/// Whether a field of this part of the hash is not its default.
inline bool has_other_than_default(const Material& material, MaterialHash part) {
  static const Material absent;
  bool is_set = false;
  visit_fields(material, [&]<typename T>(const MaterialField& row, const T& value) {
    is_set = is_set || (row.hash == part && value != absent.*std::get<T Material::*>(row.at));
  });
  return is_set;
}

}  // namespace trueshade
