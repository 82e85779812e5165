#include "raster/textures/texture.h"

#include <algorithm>
#include <bit>

#include "core/simd/dispatch.h"

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

// Whether lookups in two textures go to the same texels of the same levels.
static bool read_alike(const std::optional<TextureView>& a, const std::optional<TextureView>& b) {
  if (!a || !b) return true;
  return a->sampler == b->sampler && a->uv_set == b->uv_set && a->levels == b->levels &&
         a->level[0].width == b->level[0].width && a->level[0].height == b->level[0].height &&
         bytes_per_texel(a->format) == bytes_per_texel(b->format);
}

SceneMaps scene_maps(const Scene& scene, const Pipeline& pipeline) {
  const bool specular =
      reads_specular_plane(pipeline.light_model) && pipeline.light_model.specular_source == SpecularSource::material;
  SceneMaps maps{{}, pipeline.gbuffer.uv.interpolation, pipeline.gbuffer.albedo.interpolation};
  if (std::none_of(scene.materials.begin(), scene.materials.end(),
                   [](const Material& m) { return m.textured() || m.masked(); }))
    return maps;
  for (const Material& m : scene.materials) {
    const auto view = [&](const TextureSlot& slot) -> std::optional<TextureView> {
      if (!slot.used()) return std::nullopt;
      return view_of(scene.textures[size_t(slot.texture)], slot.sampler, slot.uv_set);
    };
    maps.material.push_back({view(m.color_map), view(m.normal_map), specular ? view(m.specular_map) : std::nullopt,
                             m.normal_scale, m.base_color.a, m.alpha_cutoff});
    MaterialMaps& made = maps.material.back();
    made.same_texels = read_alike(made.color, made.normal) && read_alike(made.color, made.specular) &&
                       read_alike(made.normal, made.specular);
    for (const std::optional<TextureView>* map : {&made.color, &made.normal, &made.specular})
      if (*map) made.uv_sets = std::max(made.uv_sets, int((*map)->uv_set) + 1);
    maps.uv_sets = std::max(maps.uv_sets, made.uv_sets);
  }
  return maps;
}
}  // namespace trueshade
