#include "shading/output/light_planes.h"

#include <charconv>

#include "shading/output/texels.h"

namespace trueshade {

std::optional<size_t> light_of_plane(std::string_view name) {
  constexpr std::string_view kPrefix = "light.";
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const std::string_view digits = name.substr(kPrefix.size());
  if (digits.empty() || (digits.size() > 1 && digits[0] == '0')) return std::nullopt;
  size_t light = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), light);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return light;
}

namespace {

constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};

void store(const ColorTile& color, const TileRect& rect, Image& image) {
  TexelSource source;
  for (int c = 0; c < 3; ++c) source.plane[c] = color.plane[c];
  store_texels(source, rect, HalfRound::toward_zero, image);
}

}  // namespace

LightPlanes::LightPlanes(std::span<const std::string> planes, const Scene& scene, const Pipeline& pipeline,
                         const LightMeshes& meshes, const View& view)
    : model_(pipeline.light_model) {
  for (size_t i = 0; i < planes.size(); ++i)
    if (const std::optional<size_t> light = light_of_plane(planes[i])) {
      const std::span<const Light> alone = std::span(scene.lights).subspan(*light, 1);
      Plane plane{i, *light, alone, make_light_table(alone, model_, scene.camera), {}};
      bound_by_extents(plane.table, alone, pipeline.light_volumes, pipeline.strategy == Strategy::deferred_volumes);
      if (blends_lights(pipeline.strategy)) plane.outlines = outlines_of_draws(alone, pipeline, meshes, view, 1);
      planes_.push_back(std::move(plane));
    }
}

void LightPlanes::sum(const SurfaceTile& surface, const TileRect& rect, bool culling, bool compiled, LightLists& work,
                      ColorTile& color, std::span<NamedImage> planes) const {
  for (const Plane& plane : planes_) {
    LightCounts uncounted;
    light_tile(surface, rect.size, plane.table, LightGroups{}, model_, kNothing, {culling, compiled}, work, color,
               uncounted);
    store(color, rect, planes[plane.index].image);
  }
}

void LightPlanes::blend(const LightDraws& frame, const SurfaceTile& surface, const TiedFragments* tied,
                        const TileRect& rect, BlendWork& work, ColorTile& color, std::span<NamedImage> planes) const {
  const LightGroups ungrouped;
  for (const Plane& plane : planes_) {
    const LightDraws draws{plane.alone,    plane.table,
                           ungrouped,      frame.model,
                           frame.volumes,  frame.meshes,
                           plane.outlines, frame.view,
                           kAddLight,      {Format::rgba32f, NumericProfile::ideal, frame.target.half_round},
                           false,          false,
                           frame.culling,  frame.compiled,
                           frame.settles};
    // What the first draw leaves is one fragment's, however many share the pixel.
    const bool in_first = frame.first_base && plane.light == 0;
    LightCounts uncounted;
    blend_tile(draws, surface, in_first ? nullptr : tied, rect, kNothing, work, color, uncounted);
    store(color, rect, planes[plane.index].image);
  }
}

}  // namespace trueshade
