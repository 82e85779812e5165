#include "shading/output/target.h"

#include "shading/output/light_planes.h"
#include "shading/output/texels.h"

namespace trueshade {
namespace {

enum class TileForm : uint8_t { values, codes };

void write_tile(const ColorTile& color, TileForm form, const TileRect& rect, HalfRound half_round, Image& target) {
  TexelSource source;
  for (int c = 0; c < 4; ++c) source.plane[c] = color.plane[c];
  source.coded = form == TileForm::codes;
  store_texels(source, rect, half_round, target);
}

/// Planes [first, first + count) of a surface, alpha 1 after three.
TexelSource planes_of(const SurfaceTile& surface, int first, int count) {
  TexelSource source;
  for (int c = 0; c < count; ++c) source.plane[c] = surface.plane[first + c];
  source.constant[3] = 1.0f;
  source.covered = surface.covered;
  return source;
}

/// Integers as the bits they are.
TexelSource bits_of(const uint32_t* integers, const int32_t* covered) {
  TexelSource source;
  source.plane[0] = reinterpret_cast<const float*>(integers);
  source.covered = covered;
  return source;
}

TexelSource source_of(std::string_view name, const VisibilityTile& visible, const SurfaceTile& surface,
                      const ColorTile& color) {
  if (name == "id.object") return bits_of(surface.object, surface.covered);
  if (name == "id.material") return bits_of(surface.material, surface.covered);
  if (name == "light.count") return bits_of(color.light_count, surface.covered);
  if (name == "overdraw") return bits_of(color.light_count, nullptr);
  if (name == "position") return planes_of(surface, kPosition, 3);
  if (name == "albedo") return planes_of(surface, kAlbedo, 4);
  if (name == "uv") return planes_of(surface, kUv, 2);
  if (name == "normal") return planes_of(surface, kNormal, 3);
  TexelSource distance;
  distance.plane[0] = name == "Z" ? color.plane[0] : visible.depth;
  if (name == "Z") distance.covered = surface.covered;
  return distance;
}

}  // namespace

void store_target(const ColorTile& color, const TileRect& rect, HalfRound half_round, Image& target) {
  write_tile(color, TileForm::values, rect, half_round, target);
}

void write_stored(const ColorTile& stored, const TileRect& rect, Image& target) {
  write_tile(stored, TileForm::codes, rect, HalfRound::toward_zero, target);
}

void store_aov(std::string_view name, const VisibilityTile& visible, const SurfaceTile& surface, const ColorTile& color,
               const TileRect& rect, HalfRound half_round, Image& plane) {
  TexelSource source = source_of(name, visible, surface, color);
  source.halved = name == "normal" && info(plane.format).number_class == NumberClass::unorm;
  store_texels(source, rect, half_round, plane);
}

void store_material_plane(std::string_view name, const SurfaceTile& surface, const LightModel& model,
                          const TileRect& rect, HalfRound half_round, Image& plane) {
  TexelSource source;
  if (name == "emission") {
    source = planes_of(surface, kEmission, model.emission ? 4 : 0);
  } else if (reads_specular_plane(model)) {
    source = planes_of(surface, kSpecular, 4);
  } else {
    source = planes_of(surface, kAlbedo, model.specular_source == SpecularSource::albedo ? 3 : 0);
    for (int c = 0; c < 3; ++c) source.constant[c] = model.specular_color[c];
    source.constant[3] = model.shininess;
  }
  store_texels(source, rect, half_round, plane);
}

Format aov_format(std::string_view name, const GBufferState& planes) {
  if (name == "depth" || name == "Z") return Format::d32f;
  if (name == "position") return planes.position_from_depth ? Format::rgba32f : planes.position.format;
  if (name == "normal") return planes.normal.format;
  if (name == "albedo") return planes.albedo.format;
  if (name == "uv") return planes.uv.format;
  if (name == "specular") return planes.specular;
  if (name == "emission") return planes.emission;
  return light_of_plane(name) ? Format::rgb32f : Format::r32ui;
}

}  // namespace trueshade
