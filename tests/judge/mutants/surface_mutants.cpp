#include "tests/judge/mutants/surface_mutants.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace trueshade::oracle {

namespace {

// --- what both are given --------------------------------------------------------------------------------------------

/// x and y anywhere, z up.
Texture bumps(TextureFormat format, int width, int height, uint32_t seed) {
  Texture texture{"bumps", format, {{width, height, {}}}};
  for (int i = 0; i < width * height; ++i) {
    std::array<float, 4> value{0, 0, 0, 1};
    for (size_t k = 0; k < 3; ++k) {
      seed = seed * 1664525u + 1013904223u;
      value[k] = float(seed >> 8) / float(1 << 24);
    }
    value[2] = 0.6f + 0.4f * value[2];
    append_texel(format, value, texture.levels[0].bytes);
  }
  build_mip_chain(texture);
  return texture;
}

TextureSlot slot_of(size_t texture, bool filtered) {
  TextureSlot slot;
  slot.texture = int32_t(texture);
  if (filtered) return slot;
  slot.sampler.mag_filter = slot.sampler.min_filter = Filter::nearest;
  slot.sampler.mip_filter = MipFilter::none;
  return slot;
}

void ten_bits(Scene&, Pipeline& p) { p.gbuffer.normal.format = Format::rgb10_a2; }
void ten_bits_on_curves(Scene& s, Pipeline& p) {
  ten_bits(s, p);
  p.light_model.renormalize = true;
}
/// For what is stored wrongly afterwards.
void float_normals(Scene&, Pipeline& p) { p.gbuffer.normal.format = Format::rgba32f; }

// --- what the wrong one is given ------------------------------------------------------------------------------------

template <class Change>
Texture changed(const Texture& from, const Change& change) {
  Texture out = from;
  for (size_t level = 0; level < from.levels.size(); ++level) {
    out.levels[level].bytes.clear();
    for (int y = 0; y < from.levels[level].height; ++y)
      for (int x = 0; x < from.levels[level].width; ++x)
        append_texel(from.format, change(texel_value(from, level, x, y)), out.levels[level].bytes);
  }
  return out;
}

using Texel = std::array<float, 4>;

template <class Change>
void each_map(Scene& scene, TextureSlot Material::*slot, const Change& change) {
  std::set<int32_t> done;
  for (const Material& m : scene.materials)
    if ((m.*slot).used() && done.insert((m.*slot).texture).second) {
      Texture& texture = scene.textures[size_t((m.*slot).texture)];
      texture = changed(texture, change);
    }
}

void green_turned(Scene& s, Pipeline&) {
  each_map(s, &Material::normal_map, [](Texel t) { return Texel{t[0], 1 - t[1], t[2], t[3]}; });
}
void red_turned(Scene& s, Pipeline&) {
  each_map(s, &Material::normal_map, [](Texel t) { return Texel{1 - t[0], t[1], t[2], t[3]}; });
}
void axes_swapped(Scene& s, Pipeline&) {
  each_map(s, &Material::normal_map, [](Texel t) { return Texel{t[1], t[0], t[2], t[3]}; });
}
void not_decoded(Scene& s, Pipeline&) {
  each_map(s, &Material::normal_map, [](Texel t) {
    return Texel{0.5f + 0.5f * t[0], 0.5f + 0.5f * t[1], 0.5f + 0.5f * t[2], t[3]};
  });
}
/// Normals decoded by (k - 127.5) / 128.
void decoded_by_128(Scene& s, Pipeline&) {
  each_map(s, &Material::normal_map, [](Texel t) {
    for (size_t k = 0; k < 3; ++k) t[k] = 0.5f + (t[k] - 0.5f) * (255.0f / 256.0f);
    return t;
  });
}
void from_srgb(Scene& s, TextureSlot Material::*slot) {
  each_map(s, slot, [](Texel t) {
    for (size_t k = 0; k < 3; ++k) {
      const auto c = double(t[k]);
      t[k] = float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return t;
  });
}
void bumps_from_srgb(Scene& s, Pipeline&) { from_srgb(s, &Material::normal_map); }
void gloss_from_srgb(Scene& s, Pipeline&) { from_srgb(s, &Material::specular_map); }
void no_bumps(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.normal_map = {};
}
void no_gloss(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.specular_map = {};
}
void no_scale(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.normal_scale = 1.0f;
}
void maps_exchanged(Scene& s, Pipeline&) {
  for (Material& m : s.materials) std::swap(m.normal_map, m.specular_map);
}
/// B = N x T whatever the texture coordinates do: wrong where they are mirrored.
void handedness_lost(Scene& s, Pipeline&) {
  const size_t materials = s.materials.size();
  for (size_t i = 0; i < materials; ++i) {  // the same, its bumps turned
    Material m = s.materials[i];
    if (m.normal_map.used()) {
      const Texture& texture = s.textures[size_t(m.normal_map.texture)];
      s.textures.push_back(changed(texture, [](Texel t) { return Texel{t[0], 1 - t[1], t[2], t[3]}; }));
      m.normal_map.texture = int32_t(s.textures.size() - 1);
    }
    s.materials.push_back(m);
  }
  for (Instance& instance : s.instances) {
    const Mesh& mesh = s.meshes[instance.mesh];
    if (!mesh.has_uv() || mesh.indices.empty()) continue;
    const auto at = [&](size_t i, size_t k) { return mesh.uv[k][mesh.indices[i]]; };
    // Seen from outside, u to the right and v up, or not; of our bases that is the same all over a mesh, or nearly.
    const float area = (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(2, 0) - at(0, 0)) * (at(1, 1) - at(0, 1));
    if (area < 0) instance.material += uint32_t(materials);
  }
}

/// What both are given: all faces that are seen are backs, of materials some of which are double-sided.
void show_backs(Scene& s, Pipeline& p) {
  add_bumps(s, p);
  for (size_t i = 0; i < s.materials.size(); ++i) s.materials[i].double_sided = i % 3 != 2;
  p.geometry.front_face = FrontFace::cw;
  p.geometry.cull_face = CullFace::back;
}
void backs_not_turned(Scene& s, Pipeline& p) {
  const auto nothing = uint32_t(s.meshes.size());
  s.meshes.emplace_back();
  for (Instance& i : s.instances)
    if (!s.materials[i.material].double_sided) i.mesh = nothing;
  for (Material& m : s.materials) m.double_sided = false;
  p.geometry.cull_face = CullFace::none;
}
void backs_culled(Scene& s, Pipeline&) {
  for (size_t i = 0; i < s.materials.size(); i += 3) s.materials[i].double_sided = false;
}
/// The same with maps that read the second set of texture coordinates.
void use_second_uv(Scene& s, Pipeline& p) {
  add_bumps(s, p);
  for (Mesh& mesh : s.meshes) {
    mesh.more_uv = {{mesh.uv[1], mesh.uv[0]}};
    for (float& v : mesh.more_uv[0][1]) v = 0.3f - 1.5f * v;
  }
  for (Material& m : s.materials)
    for (TextureSlot* map : maps_of(m)) map->uv_set = 1;
}
void first_uv(Scene& s, Pipeline&) {
  for (Material& m : s.materials)
    for (TextureSlot* map : maps_of(m)) map->uv_set = 0;
}
void metal_exchanged(Scene& s, Pipeline&) {
  each_map(s, &Material::metallic_roughness_map, [](Texel t) { return Texel{t[0], t[2], t[1], t[3]}; });
}
void no_metal_map(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.metallic_roughness_map = {};
}
void metal_from_srgb(Scene& s, Pipeline&) { from_srgb(s, &Material::metallic_roughness_map); }
void no_emission_map(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.emission_map = {};
}
void emission_from_srgb(Scene& s, Pipeline&) { from_srgb(s, &Material::emission_map); }
void emission_alone(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.emission = glm::vec3(1.0f);
}
void no_occlusion(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.occlusion_map = {};
}
void full_occlusion(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.occlusion_strength = 1.0f;
}
void occlusion_of_green(Scene& s, Pipeline&) {
  each_map(s, &Material::occlusion_map, [](Texel t) { return Texel{t[1], t[1], t[2], t[3]}; });
}
void nothing_unlit(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.unlit = false;
}

void points_unlimited(Scene&, Pipeline& p) { p.light_volumes.point = LightExtent::unbounded; }
void spots_unlimited(Scene&, Pipeline& p) { p.light_volumes.spot = LightExtent::unbounded; }
void extents_exchanged(Scene&, Pipeline& p) { std::swap(p.light_volumes.point, p.light_volumes.spot); }
void extents_alike(Scene&, Pipeline& p) { p.light_volumes.spot = p.light_volumes.point; }
void spots_skipped(Scene& s, Pipeline&) {
  std::erase_if(s.lights, [](const Light& l) { return l.type == LightType::spot; });
}

// --- what it gives --------------------------------------------------------------------------------------------------

/// The float normals as codes of ten bits, `code(n)`.
template <class Code>
void store_normals(Capture& capture, const Code& code) {
  for (NamedImage& plane : capture.planes) {
    if (plane.name != "normal" || plane.image.format != Format::rgba32f) continue;
    Image codes(plane.image.width, plane.image.height, Format::rgb10_a2);
    for (int y = 0; y < codes.height; ++y)
      for (int x = 0; x < codes.width; ++x) {
        if (plane.image.value(x, y, 3) == 0) continue;
        for (int k = 0; k < 3; ++k)
          codes.set_code(x, y, k, uint32_t(std::clamp(code(plane.image.value(x, y, k)), 0.0, 1023.0)));
        codes.set_code(x, y, 3, 3);
      }
    plane.image = std::move(codes);
  }
}
void stored_whole(const Pipeline&, Capture& c) {
  store_normals(c, [](double n) { return std::nearbyint(1023 * n); });
}
void stored_about_512(const Pipeline&, Capture& c) {
  store_normals(c, [](double n) { return std::nearbyint(512 + 511 * n); });
}
void stored_in_8_bits(const Pipeline&, Capture& c) {
  store_normals(c, [](double n) { return std::nearbyint(1023.0 / 255 * std::nearbyint(255 * (0.5 + 0.5 * n))); });
}

void normals_not_made_unit(Scene&, Pipeline& p) { p.light_model.renormalize = false; }

constexpr Mutant kSurfaceMutants[] = {
    {"normal map's green turned", kNone, add_bumps, green_turned, nullptr},
    {"normal map's red turned", kNone, add_bumps, red_turned, nullptr},
    {"normal map's red and green exchanged", kNone, add_bumps, axes_swapped, nullptr},
    {"tangents' handedness lost", kNone, add_bumps, handedness_lost, nullptr},
    {"normal map not decoded", kNone, add_bumps, not_decoded, nullptr},
    {"normal map decoded by 128", kNone, add_bumps, decoded_by_128, nullptr},
    {"normal map read as sRGB", kNone, add_bumps, bumps_from_srgb, nullptr},
    {"normal map ignored", kNone, add_bumps, no_bumps, nullptr},
    {"normal map's scale ignored", kNone, add_bumps, no_scale, nullptr},
    {"specular map ignored", kNone, add_bumps, no_gloss, nullptr},
    {"specular map read as sRGB", kNone, add_bumps, gloss_from_srgb, nullptr},
    {"normal and specular map exchanged", kNone, add_bumps, maps_exchanged, nullptr},
    {"metallic and roughness exchanged", kNone, add_metal, metal_exchanged, nullptr},
    {"metallic-roughness map ignored", kNone, add_metal, no_metal_map, nullptr},
    {"metallic-roughness map read as sRGB", kNone, add_metal, metal_from_srgb, nullptr},
    {"emission map ignored", kNone, add_metal, no_emission_map, nullptr},
    {"emission map read as sRGB", kNone, add_metal, emission_from_srgb, nullptr},
    {"emission map without the emission", kNone, add_metal, emission_alone, nullptr},
    {"occlusion map ignored", kNone, add_metal, no_occlusion, nullptr},
    {"occlusion's strength ignored", kNone, add_metal, full_occlusion, nullptr},
    {"occlusion of green", kNone, add_metal, occlusion_of_green, nullptr},
    {"unlit surfaces lit", kNone, add_metal, nothing_unlit, nullptr},
    {"ten-bit normals stored as n", kNone, ten_bits, float_normals, stored_whole},
    {"ten-bit normals stored about 512", kNone, ten_bits, float_normals, stored_about_512},
    {"ten-bit normals of eight bits", kNone, ten_bits, float_normals, stored_in_8_bits},
    {"ten-bit normals not made unit", Latitude::stated_rules, ten_bits_on_curves, normals_not_made_unit, nullptr},
    {"backs' normals not turned", kNone, show_backs, backs_not_turned, nullptr},
    {"double-sided backs culled", kNone, show_backs, backs_culled, nullptr},
    {"maps read at the first texture coordinates", kNone, use_second_uv, first_uv, nullptr},
    {"point lights' extent ignored", kNone, mix_extents, points_unlimited, nullptr},
    {"spot lights' extent ignored", kNone, mix_extents, spots_unlimited, nullptr},
    {"extents of points and spots exchanged", kNone, mix_extents, extents_exchanged, nullptr},
    {"spots given the points' extent", kNone, mix_extents, extents_alike, nullptr},
    {"lights of one extent skipped", kNone, mix_extents, spots_skipped, nullptr},
};

}  // namespace

void add_texture_coordinates(Scene& scene) {
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    if (mesh.has_uv()) continue;
    const float sign = m % 2 == 0 ? 1.0f : -1.0f;
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      mesh.uv[0].push_back(sign * (mesh.position[0][v] + 0.37f * mesh.position[1][v]));
      mesh.uv[1].push_back(mesh.position[2][v] - 0.21f * mesh.position[1][v]);
    }
  }
}

void add_bumps(Scene& scene, Pipeline& pipeline) {
  add_texture_coordinates(scene);
  const size_t first = scene.textures.size();
  scene.textures.push_back(bumps(TextureFormat::rgba8, 8, 12, 1));
  scene.textures.push_back(bumps(TextureFormat::rgba32f, 5, 3, 2));
  scene.textures.push_back(bumps(TextureFormat::rgba8, 8, 8, 3));
  scene.textures.push_back(bumps(TextureFormat::rgba16f, 6, 4, 4));
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.specular_color = {0.3f, 0.2f, 0.4f};
    m.specular_map = slot_of(first + 2 + i % 2, i % 2 == 0);
    if (i % 5 == 4) continue;  // a material without a normal map among the others
    m.normal_map = slot_of(first + i % 2, i % 3 == 2);
    m.normal_scale = i % 2 == 0 ? 0.75f : 0.5f;
  }
  LightModel& model = pipeline.light_model;
  if (model.order == TermOrder::albedo_last) return;
  model.specular_source = SpecularSource::material;
  if (model.specular == Specular::none) model.specular = Specular::blinn_phong;
}

void add_metal(Scene& scene, Pipeline& pipeline) {
  add_texture_coordinates(scene);
  const size_t first = scene.textures.size();
  for (const int side : {8, 5, 6}) {  // a texture a map, so that each can be changed alone
    scene.textures.push_back(bumps(TextureFormat::rgba8, side, 12, uint32_t(side)));
    scene.textures.push_back(bumps(TextureFormat::rgba16f, side + 1, 4, uint32_t(2 * side)));
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.metallic = 0.8f, m.roughness = 0.9f, m.occlusion_strength = 0.7f;
    m.emission = {0.2f, 0.05f, 0.3f};
    m.metallic_roughness_map = slot_of(first + i % 2, i % 2 == 0);
    m.emission_map = slot_of(first + 2 + i % 2, i % 2 == 1);
    m.occlusion_map = slot_of(first + 4 + i % 2, i % 2 == 0);
    m.unlit = i % 4 == 3 || (scene.materials.size() < 4 && i == 0);
  }
  Light sky;
  sky.type = LightType::ambient;
  sky.color = {0.3f, 0.4f, 0.5f};
  scene.lights.push_back(sky);
  LightModel& model = pipeline.light_model;
  model.specular_source = SpecularSource::metallic_roughness;
  model.emission = true;
}

void mix_extents(Scene& scene, Pipeline& pipeline) {
  size_t lamps = 0;
  for (Light& light : scene.lights) {
    if (light.type != LightType::point && light.type != LightType::spot) continue;
    const glm::vec3 d = scene.camera.target - light.position;
    const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    light.range = 0.8f * length;
    light.attenuation = {1.0f, 0.0f, 0.0f};
    if (lamps++ % 2 == 0) continue;
    light.type = LightType::spot;
    light.direction = length > 0 ? d * (1 / length) : glm::vec3(0.0f, 0.0f, -1.0f);
    light.cone_rad = 1.2f, light.penumbra_rad = 0.2f;
  }
  pipeline.light_model.falloff = Falloff::quadratic;
  const bool drawn = pipeline.strategy == Strategy::deferred_volumes;
  pipeline.light_volumes.point = drawn ? LightExtent::box : LightExtent::range;
  pipeline.light_volumes.spot = drawn ? LightExtent::range : LightExtent::unbounded;
  pipeline.light_volumes.cull_face = CullFace::front;
}

std::span<const Mutant> surface_mutants() { return kSurfaceMutants; }

}  // namespace trueshade::oracle
