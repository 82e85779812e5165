#include "scenes/files/content/faults.h"

#include <algorithm>

#include "core/printable_text.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

/// How a note tells of one fault, and of several, with their number before it.
struct FaultWords {
  const char *one, *several;
};
constexpr FaultWords kWords[kFaults] = {
    {"picture cannot be read, so what it colours is grey", "pictures cannot be read, so what they colour is grey"},
    {"material library cannot be read, so its materials are grey",
     "material libraries cannot be read, so their materials are grey"},
    {"required extension is left out", "required extensions are left out"},
    {"place of numbers is not aligned, and read all the same",
     "places of numbers are not aligned, and read all the same"},
    {"stride is none that glTF has there, and is taken as it is",
     "strides are none that glTF has there, and are taken as they are"},
    {"node of a scene is no root, and is drawn", "nodes of scenes are no roots, and are drawn"},
    {"mesh lacks the texture coordinates that its material reads, which are 0",
     "meshes lack the texture coordinates that their materials read, which are 0"},
    {"statement is left out", "statements are left out"},
    {"value is left out", "values are left out"}};

constexpr size_t kNamed = 5;
constexpr std::string_view kRemedy = "add --lenient to look at it all the same";

/// The same error, with that behind its own remedy, once.
Error with_remedy(const Error& error) {
  const std::string text = error.what();
  if (text.ends_with(std::string(kRemedy) + ')')) return error;
  const size_t where = text.find(": "), remedy = text.rfind(" (");
  return {error.kind(), text.substr(0, where), text.substr(where + 2, remedy - where - 2),
          text.substr(remedy + 2, text.size() - remedy - 3) + "; " + std::string(kRemedy)};
}

}  // namespace

std::string Faults::remedy(std::string_view remedy) const {
  std::string text(remedy);
  if (leniency_ == Leniency::offered) text += "; " + std::string(kRemedy);
  return text;
}

void Faults::pass(Fault fault, const std::string& where, std::string_view reason, std::string_view remedy) {
  if (!passed()) throw Error(ErrorKind::bad_input, where, reason, this->remedy(remedy));
  add(fault, where, where + ": " + std::string(reason));
}

void Faults::pass(Fault fault, const std::string& key, const Error& error) {
  const bool is_of_content = error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::io;
  if (is_of_content && leniency_ == Leniency::offered) throw with_remedy(error);
  if (!is_of_content || !passed()) throw error;
  const std::string_view text = error.what();
  const size_t remedy = text.rfind(" (");
  add(fault, key, text.substr(0, remedy));
  found_[size_t(fault)].any_untrusted |= text.find(kTrustRemedy, remedy) != std::string_view::npos;
}

void Faults::add(Fault fault, const std::string& key, std::string_view text) {
  constexpr size_t kLongest = 200;
  Found& found = found_[size_t(fault)];
  if (found.keys.insert(key).second && found.first.size() < kNamed)
    found.first.push_back(printable(text.substr(0, kLongest), Lines::one));
}

void Faults::tell(Scene& scene) const {
  std::vector<std::string> lines;
  for (size_t i = 0; i < kFaults; ++i) {
    const Found& found = found_[i];
    const size_t count = found.keys.size();
    if (count == 0) continue;
    std::string line = std::to_string(count) + ' ' + (count == 1 ? kWords[i].one : kWords[i].several) + ": ";
    for (size_t k = 0; k < found.first.size(); ++k) line += (k > 0 ? "; " : "") + found.first[k];
    if (count > kNamed) line += "; and " + std::to_string(count - kNamed) + " more";
    if (found.any_untrusted) line += " (add " + std::string(kTrustRemedy) + ", to read what lies outside its folder)";
    lines.push_back(std::move(line));
  }
  tell_passed_over(lines, scene);
}

void tell_passed_over(const std::vector<std::string>& lines, Scene& scene) {
  for (const std::string& line : lines) {
    scene.passed_over.push_back(line);
    scene.notes.push_back("As --lenient asks, which makes this no reference: " + line);
  }
}

std::string lenient_text(const Scene& scene) {
  std::string text;
  for (const std::string& line : scene.passed_over) text += (text.empty() ? "" : ". ") + line;
  return text;
}

void lose_map(Material& material, TextureSlot Material::*map) {
  constexpr float kGrey = 0.5f;
  material.*map = TextureSlot();
  if (map == &Material::color_map) {
    for (int k = 0; k < 3; ++k) material.base_color[k] *= kGrey;
  } else if (map == &Material::specular_map) {
    for (int k = 0; k < 3; ++k) material.specular_color[k] *= kGrey;
  } else if (map == &Material::metallic_roughness_map) {
    material.roughness *= kGrey, material.metallic *= kGrey;
  } else if (map == &Material::emission_map) {
    material.emission = glm::vec3(0.0f);
  } else if (map == &Material::normal_map) {
    material.normal_scale = 1.0f;
  } else {
    material.occlusion_strength = 1.0f;
  }
}

void lose_textures(Scene& scene, const std::vector<bool>& lost) {
  constexpr TextureSlot Material::*kMaps[kMaterialMaps] = {&Material::color_map,    &Material::specular_map,
                                                           &Material::normal_map,   &Material::metallic_roughness_map,
                                                           &Material::emission_map, &Material::occlusion_map};
  if (std::find(lost.begin(), lost.end(), true) == lost.end()) return;
  std::vector<int32_t> kept(lost.size(), -1);
  std::vector<Texture> textures;
  for (size_t i = 0; i < lost.size(); ++i) {
    if (lost[i]) continue;
    kept[i] = int32_t(textures.size());
    textures.push_back(std::move(scene.textures[i]));
  }
  scene.textures = std::move(textures);
  for (Material& material : scene.materials)
    for (TextureSlot Material::*map : kMaps) {
      TextureSlot& slot = material.*map;
      if (!slot.used()) continue;
      const int32_t texture = kept[size_t(slot.texture)];
      if (texture < 0)
        lose_map(material, map);
      else
        slot.texture = texture;
    }
}

}  // namespace trueshade
