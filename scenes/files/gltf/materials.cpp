#include "scenes/files/gltf/materials.h"

namespace trueshade::gltf {
bool Materials::is_invisible(uint32_t index) const {
  if (index == kNone) return false;
  const MaterialSource& m = document_.materials[index];
  return m.alpha_mode == AlphaMode::mask && m.alpha_cutoff > 1.0f;
}

uint32_t Materials::scene_material(uint32_t index) {
  const auto [found, is_new] = materials_.emplace(index, uint32_t(scene_.materials.size()));
  if (!is_new) return found->second;
  MaterialSource from = index == kNone ? MaterialSource() : document_.materials[index];
  const std::string pointer = pointer_to("materials", index);
  if (from.alpha_mode == AlphaMode::unknown) {
    faults_.pass(Fault::value, document_.file + ": " + pointer + "/alphaMode", "this mode is not in glTF",
                 "OPAQUE, MASK or BLEND");
    from.alpha_mode = AlphaMode::opaque;
  }
  Material m;
  m.name = from.name;
  m.base_color = from.base_color;
  m.metallic = from.metallic;
  m.roughness = from.roughness;
  for (int k = 0; k < 3; ++k) m.emission[k] = float(double(from.emission[k]) * double(from.emission_strength));
  set_map(from.base_color_map, TextureFormat::srgb8_a8, &Material::color_map, m);
  set_map(from.metallic_roughness_map, TextureFormat::rgba8, &Material::metallic_roughness_map, m);
  set_map(from.normal_map, TextureFormat::rgba8, &Material::normal_map, m);
  m.normal_scale = m.normal_map.used() ? from.normal_scale : 1.0f;
  set_map(from.occlusion_map, TextureFormat::rgba8, &Material::occlusion_map, m);
  m.occlusion_strength = m.occlusion_map.used() ? from.occlusion_strength : 1.0f;
  set_map(from.emission_map, TextureFormat::srgb8_a8, &Material::emission_map, m);
  m.alpha_cutoff = from.alpha_mode == AlphaMode::mask ? from.alpha_cutoff : 0.0f;
  m.transparent = from.alpha_mode == AlphaMode::blend;
  if (from.alpha_mode == AlphaMode::opaque) m.base_color.w = 1.0f;
  m.unlit = from.unlit;
  m.double_sided = from.double_sided;
  scene_.materials.push_back(std::move(m));
  uv_sources_.push_back({from.base_color_map.uv,
                         {},
                         from.normal_map.uv,
                         from.metallic_roughness_map.uv,
                         from.emission_map.uv,
                         from.occlusion_map.uv});
  return found->second;
}

void Materials::set_map(const TextureInfo& info, TextureFormat format, TextureSlot Material::*map, Material& m) {
  if (info.texture == kNone) return;
  const TextureSource& source = document_.textures[info.texture];
  if (source.image == kNone) {
    faults_.pass(Fault::picture, document_.file + ": " + pointer_to("textures", info.texture),
                 source.other_image.empty()
                     ? "the texture has no source"
                     : "the texture has a source of " + source.other_image + " alone, which is not implemented",
                 "a source that is PNG or JPEG");
    return lose_map(m, map);
  }
  TextureSlot& slot = m.*map;
  slot.sampler = source.sampler;
  slot.texture = pictures_.texture(source.image, format, slot.sampler.mip_filter != MipFilter::none);
}

}  // namespace trueshade::gltf
