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
                         const ProgramFrame* program, const LightMeshes& meshes, const View& view)
    : model_(pipeline.light_model) {
  for (size_t i = 0; i < planes.size(); ++i)
    if (const std::optional<size_t> light = light_of_plane(planes[i])) {
      const std::span<const Light> alone = std::span(scene.lights).subspan(*light, 1);
      Plane plane{i, *light, alone, make_light_table(alone, model_, scene.camera), {}};
      bound_by_extents(plane.table, alone, pipeline.light_volumes, pipeline.strategy == Strategy::deferred_volumes);
      plane.table.program = program, plane.table.first_light = uint32_t(*light);
      if (blends_lights(pipeline.strategy)) plane.outlines = outlines_of_draws(alone, pipeline, meshes, view, 1);
      planes_.push_back(std::move(plane));
    }
}

void LightPlanes::sum(const SurfaceTile& surface, const TileRect& rect, const LightShortcuts& of_target,
                      LightLists& work, ColorTile& color, std::span<NamedImage> planes) const {
  const LightShortcuts shortcuts{.culling = of_target.culling, .compiled = of_target.compiled, .light_alone = true};
  for (const Plane& plane : planes_) {
    LightCounts uncounted;
    light_tile(surface, rect.size, plane.table, LightClusters{}, model_, kNothing, shortcuts, work, color, uncounted);
    store(color, rect, planes[plane.index].image);
  }
}

void LightPlanes::blend(const LightVolumeDraws& frame, const SurfaceTile& surface, const TiedFragments* tied,
                        const TileRect& rect, BlendWork& work, ColorTile& color, std::span<NamedImage> planes) const {
  const LightClusters no_clusters;
  for (const Plane& plane : planes_) {
    const LightVolumeDraws draws{.lights = plane.alone,
                                 .table = plane.table,
                                 .clusters = no_clusters,
                                 .model = frame.model,
                                 .volumes = frame.volumes,
                                 .meshes = frame.meshes,
                                 .outlines = plane.outlines,
                                 .view = frame.view,
                                 .blend = kAddLight,
                                 .target = {Format::rgba32f, NumericProfile::ideal, frame.target.half_round},
                                 .base = false,
                                 .first_base = false,
                                 .culling = frame.culling,
                                 .compiled = frame.compiled,
                                 .bounded_codes = frame.bounded_codes};
    // What the first draw leaves is one fragment's, however many share the pixel.
    const bool in_first = frame.first_base && plane.light == 0;
    LightCounts uncounted;
    blend_tile(draws, surface, in_first ? nullptr : tied, rect, kNothing, work, color, uncounted);
    store(color, rect, planes[plane.index].image);
  }
}

}  // namespace trueshade
