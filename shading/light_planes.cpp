#include "shading/light_planes.h"

#include <charconv>
#include <cstring>

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

LightPlanes::LightPlanes(std::span<const std::string> planes, const Scene& scene, const Pipeline& pipeline)
    : model_(pipeline.light_model) {
  for (size_t i = 0; i < planes.size(); ++i)
    if (const std::optional<size_t> light = light_of_plane(planes[i])) {
      const std::span<const Light> alone = std::span(scene.lights).subspan(*light, 1);
      LightTable table = make_light_table(alone, model_, scene.camera);
      bound_by_extents(table, alone, pipeline.light_volumes, pipeline.strategy == Strategy::deferred_volumes);
      planes_.push_back({i, std::move(table)});
    }
}

void LightPlanes::draw(const SurfaceTile& surface, const TileRect& rect, bool culling, bool compiled, LightLists& work,
                       ColorTile& color, std::span<NamedImage> planes) const {
  constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
  for (const Plane& plane : planes_) {
    LightCounts uncounted;
    light_tile(surface, rect.size, plane.light, LightGroups{}, model_, kNothing, {culling, compiled}, work, color,
               uncounted);
    Image& image = planes[plane.index].image;
    for (int y = 0; y < std::min(rect.size, image.height - rect.y); ++y)
      for (int x = 0; x < std::min(rect.size, image.width - rect.x); ++x) {
        const int at = tile_index(rect.size, x, y);
        const float value[3] = {color.plane[0][at], color.plane[1][at], color.plane[2][at]};
        std::memcpy(image.texel(rect.x + x, image.height - 1 - (rect.y + y)), value, sizeof value);
      }
  }
}

}  // namespace trueshade
