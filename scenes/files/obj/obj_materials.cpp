#include "scenes/files/obj/obj_materials.h"

#include <algorithm>
#include <cmath>

#include "core/fp_env.h"

namespace trueshade::obj {
namespace {

constexpr float kMaskedBelow = 0.5f;  ///< alpha of a picture

TextureSlot slot_of(int32_t texture, const MapSource& map) {
  TextureSlot slot;
  slot.texture = texture;
  if (map.clamp) slot.sampler.wrap.fill(Wrap::clamp_to_edge);
  return slot;
}

const MapSource* pointer(const std::optional<MapSource>& map) { return map ? &*map : nullptr; }

/// Sets a map to the texture that a function of ObjPictures has made.
void set_map(int32_t texture, const MapSource& map, TextureSlot Material::*slot, Material& m) {
  if (texture < 0) return lose_map(m, slot);
  m.*slot = slot_of(texture, map);
}

/// Colour and opacity.
void set_color(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures, Material& m) {
  const glm::vec3 color = from.kd.value_or(glm::vec3(from.map_kd ? 1.0f : 0.8f));
  m.base_color = glm::vec4(color, from.d.value_or(1.0f));
  m.transparent = m.base_color.w < 1.0f;
  if (from.map_d) {
    const int32_t texture = pictures.unless_lost(
        *from.map_d, [&] { return pictures.colors_with_alpha(document, pointer(from.map_kd), *from.map_d); });
    if (texture >= 0) {
      m.color_map = slot_of(texture, from.map_kd ? *from.map_kd : *from.map_d);
      if (!m.transparent) m.alpha_cutoff = kMaskedBelow;
      return;
    }
  }
  if (from.map_kd)
    set_map(pictures.unless_lost(*from.map_kd, [&] { return pictures.colors(document, *from.map_kd); }), *from.map_kd,
            &Material::color_map, m);
}

/// illum 0 is a colour without light, 1 has no highlights.
void set_gloss(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures, Material& m) {
  m.unlit = from.illum == 0;
  const bool glossy = from.illum >= 2;
  m.specular_color = glossy ? from.ks.value_or(glm::vec3(from.map_ks ? 1.0f : 0.0f)) : glm::vec3(0.0f);
  m.shininess = std::nearbyint(std::min(from.ns.value_or(32.0f), 8192.0f));
  if (glossy && from.map_ks)
    set_map(pictures.unless_lost(*from.map_ks, [&] { return pictures.colors(document, *from.map_ks); }), *from.map_ks,
            &Material::specular_map, m);
}

void set_normals(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures, Material& m) {
  const MapSource* map = from.norm ? &*from.norm : pointer(from.map_bump);
  if (!map) return;
  bool scaled = false;
  const int32_t texture =
      pictures.unless_lost(*map, [&] { return pictures.normals(document, *map, !from.norm, scaled); });
  m.normal_scale = scaled ? 1.0f : map->bump;
  set_map(texture, *map, &Material::normal_map, m);
}

void set_metal(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures, Material& m) {
  m.metallic = from.pm.value_or(from.map_pm ? 1.0f : 0.0f);
  m.roughness = from.pr.value_or(1.0f);
  if (!from.map_pr && !from.map_pm) return;
  const MapSource& map = from.map_pr ? *from.map_pr : *from.map_pm;
  set_map(pictures.unless_lost(
              map, [&] { return pictures.metallic_roughness(document, pointer(from.map_pr), pointer(from.map_pm)); }),
          map, &Material::metallic_roughness_map, m);
}

/// Where the map of an option's offset and scale is read.
UvSource source_of(const MapSource* map) { return map ? UvSource{0, {map->offset, map->scale}} : UvSource(); }

const MapSource* first_of(const std::optional<MapSource>& a, const std::optional<MapSource>& b) {
  return a ? &*a : pointer(b);
}

}  // namespace

std::vector<const MapSource*> maps_of(const MtlMaterial& m) {
  std::vector<const MapSource*> maps;
  for (const auto* map : {&m.map_d, &m.map_kd, m.illum >= 2 ? &m.map_ks : nullptr, m.norm ? &m.norm : &m.map_bump,
                          &m.map_pr, &m.map_pm, &m.map_ke})
    if (map && *map) maps.push_back(&**map);
  return maps;
}

UvSources uv_sources_of(const MtlMaterial& m) {
  return {
      source_of(first_of(m.map_kd, m.map_d)),  source_of(pointer(m.map_ks)), source_of(first_of(m.norm, m.map_bump)),
      source_of(first_of(m.map_pr, m.map_pm)), source_of(pointer(m.map_ke)), {}};
}

Material material_of(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures) {
  const FpScope fp;
  Material m;
  m.name = from.name;
  set_color(document, from, pictures, m);
  set_gloss(document, from, pictures, m);
  set_normals(document, from, pictures, m);
  set_metal(document, from, pictures, m);
  m.emission = from.ke.value_or(glm::vec3(from.map_ke ? 1.0f : 0.0f));
  if (from.map_ke)
    set_map(pictures.unless_lost(*from.map_ke, [&] { return pictures.colors(document, *from.map_ke); }), *from.map_ke,
            &Material::emission_map, m);
  return m;
}

}  // namespace trueshade::obj
