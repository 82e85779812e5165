#include "raster/textures/texture.h"

#include <algorithm>
#include <bit>

#include "core/simd/dispatch.h"
#include "scenes/pipeline/material_values.h"

namespace trueshade {
void look_up(const TextureView& texture, std::span<const TexturePoint> points, std::span<std::array<float, 4>> out) {
  kernel<look_up>()(texture, points, out);
}

TextureView view_of(const Texture& texture, const Sampler& sampler, uint8_t uv_set) {
  const bool repeats = sampler.wrap[0] == Wrap::repeat && sampler.wrap[1] == Wrap::repeat;
  const bool masks = repeats && bytes_per_texel(texture.format) == 4;
  TextureView view{texture.format, int(texture.levels.size()), {}, sampler, uv_set, masks};
  for (size_t k = 0; k < texture.levels.size(); ++k) {
    const TextureLevel& from = texture.levels[k];
    view.level[k] = {from.bytes.data(), from.width, from.height, 1.0 / from.width, 1.0 / from.height};
    view.masks = view.masks && std::has_single_bit(unsigned(from.width)) && std::has_single_bit(unsigned(from.height));
  }
  return view;
}

namespace {

/// Whether lookups in two textures go to the same texels of the same levels.
bool read_alike(const TextureView& a, const TextureView& b) {
  return a.sampler == b.sampler && a.uv_set == b.uv_set && a.levels == b.levels &&
         a.level[0].width == b.level[0].width && a.level[0].height == b.level[0].height &&
         bytes_per_texel(a.format) == bytes_per_texel(b.format);
}

MaterialMaps material_maps(const Scene& scene, const Material& m, const Pipeline& pipeline) {
  const auto view = [&](const TextureSlot& slot, bool read) -> std::optional<TextureView> {
    if (!read || !slot.used()) return std::nullopt;
    return view_of(scene.textures[size_t(slot.texture)], slot.sampler, slot.uv_set);
  };
  const MaterialValues values = material_values(m, pipeline);
  return {.color = view(m.color_map, true),
          .normal = view(m.normal_map, true),
          .specular = view(m.specular_map, values.specular_map),
          .metallic_roughness = view(m.metallic_roughness_map, values.metallic_roughness_map),
          .emission = view(m.emission_map, values.emission_map),
          .occlusion = view(m.occlusion_map, values.occlusion_map),
          .normal_scale = m.normal_scale,
          .base_alpha = m.base_color.a,
          .alpha_cutoff = m.alpha_cutoff};
}

/// Sets what is known of all maps of a material.
void compare_maps(MaterialMaps& maps) {
  const TextureView* first = nullptr;
  for (const std::optional<TextureView>* map :
       {&maps.color, &maps.specular, &maps.normal, &maps.metallic_roughness, &maps.emission, &maps.occlusion}) {
    if (!*map) continue;
    if (first == nullptr) first = &**map;
    maps.same_texels = maps.same_texels && read_alike(*first, **map);
    maps.uv_sets = std::max(maps.uv_sets, int((*map)->uv_set) + 1);
  }
  maps.values = maps.specular || maps.metallic_roughness || maps.emission || maps.occlusion;
  maps.any = first != nullptr;
}

}  // namespace

SceneMaps scene_maps(const Scene& scene, const Pipeline& pipeline) {
  SceneMaps maps{{}, pipeline.gbuffer.uv.interpolation, pipeline.gbuffer.albedo.interpolation};
  if (std::none_of(scene.materials.begin(), scene.materials.end(),
                   [](const Material& m) { return m.textured() || m.masked(); }))
    return maps;
  bool any = false;
  for (const Material& m : scene.materials) {
    MaterialMaps& made = maps.material.emplace_back(material_maps(scene, m, pipeline));
    compare_maps(made);
    any = any || made.any || m.masked();
    maps.uv_sets = std::max(maps.uv_sets, made.uv_sets);
  }
  if (!any) maps.material.clear();
  maps.tangents =
      std::any_of(maps.material.begin(), maps.material.end(),
                  [](const MaterialMaps& m) { return m.normal.has_value(); }) &&
      std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) { return mesh.has_tangents(); });
  return maps;
}
}  // namespace trueshade
