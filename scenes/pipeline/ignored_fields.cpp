#include "scenes/pipeline/ignored_fields.h"

#include <algorithm>
#include <cmath>

#include "core/fp_env.h"
#include "scenes/pipeline/material_values.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

// --- What a pipeline reads -----------------------------------------------------------------------------------------

bool reads_range(Falloff falloff) {
  return falloff == Falloff::linear_range || falloff == Falloff::linear || falloff == Falloff::inverse_square;
}

bool reads_attenuation(Falloff falloff) { return falloff == Falloff::quadratic || falloff == Falloff::attenuation; }

bool blends_transparent(const Material& material, const Pipeline& pipeline) {
  return material.transparent && pipeline.transparency.mode != TransparencyMode::none;
}

// --- Fields of lights ----------------------------------------------------------------------------------------------

/// A field of T: where it is stated and not read, it is ignored.
template <typename T>
struct Field {
  std::string_view key, reason;
  bool (*stated)(const T&);
  bool (*read)(const T&, const Pipeline&);
};

constexpr Field<Light> kIgnorableOfLights[] = {
    {"cone_deg", "The light model has no cone, so spot lights shine in all directions, as point lights do",
     [](const Light& l) { return is_spot(l.type) && l.cone_rad + l.penumbra_rad < float(kPi); },
     [](const Light&, const Pipeline& p) { return p.light_model.cone != Cone::none; }},
    {"spot_exponent", "Only the cone 'exponent' raises the cosine to a power",
     [](const Light& l) { return is_spot(l.type) && l.spot_exponent != 0.0f; },
     [](const Light&, const Pipeline& p) { return p.light_model.cone == Cone::exponent; }},
    {"range", "The falloff of the light model has no end, and no extent of light_volumes bounds the lights",
     [](const Light& l) { return is_placed(l.type) && std::isfinite(l.range); },
     [](const Light& l, const Pipeline& p) {
       return reads_range(p.light_model.falloff) || stated_extent(l.type, p.light_volumes) != LightExtent::unbounded;
     }},
    {"attenuation", "The falloff of the light model has no constant, linear and quadratic factors",
     [](const Light& l) { return is_placed(l.type) && l.attenuation != glm::vec3(1.0f, 0.0f, 0.0f); },
     [](const Light&, const Pipeline& p) { return reads_attenuation(p.light_model.falloff); }},
    {"ambient", "Only the order 'with_ambient' adds a light's share of ambient light",
     [](const Light& l) { return !is_ambient(l.type) && l.ambient != glm::vec3(0.0f); },
     [](const Light&, const Pipeline& p) { return p.light_model.order == TermOrder::with_ambient; }}};

// --- Fields of materials -------------------------------------------------------------------------------------------

constexpr std::string_view kGlossReason = "The light model does not take specular colour and shininess from materials";
constexpr std::string_view kMetalReason = "The light model has no metallic-roughness materials";
constexpr std::string_view kEmissionReason = "The light model adds no emission";

/// What a material is whose file says nothing.
const Material& default_material() {
  static const Material material;
  return material;
}

constexpr Field<Material> kIgnorableOfMaterials[] = {
    {"specular_color", kGlossReason,
     [](const Material& m) {
       return m.specular_color != default_material().specular_color && m.specular_color != glm::vec3(0.0f);
     },
     [](const Material&, const Pipeline& p) { return takes_gloss(p.light_model); }},
    {"shininess", kGlossReason, [](const Material& m) { return m.shininess != default_material().shininess; },
     [](const Material&, const Pipeline& p) { return takes_gloss(p.light_model); }},
    {"specular_map", kGlossReason, [](const Material& m) { return m.specular_map.used(); },
     [](const Material&, const Pipeline& p) { return takes_gloss(p.light_model); }},
    {"emission", kEmissionReason, [](const Material& m) { return m.emission != glm::vec3(0.0f); },
     [](const Material&, const Pipeline& p) { return p.light_model.emission; }},
    {"metallic", kMetalReason, [](const Material& m) { return m.metallic != default_material().metallic; },
     [](const Material&, const Pipeline& p) { return maps_metals(p.light_model); }},
    {"roughness", kMetalReason, [](const Material& m) { return m.roughness != default_material().roughness; },
     [](const Material&, const Pipeline& p) {
       return maps_metals(p.light_model) && reads_specular_plane(p.light_model);
     }},
    {"normal_scale", "The material has no normal_map",
     [](const Material& m) { return m.normal_scale != default_material().normal_scale; },
     [](const Material& m, const Pipeline&) { return m.normal_map.used(); }},
    {"metallic_roughness_map", kMetalReason, [](const Material& m) { return m.metallic_roughness_map.used(); },
     [](const Material&, const Pipeline& p) { return maps_metals(p.light_model); }},
    {"emission_map", kEmissionReason, [](const Material& m) { return m.emission_map.used(); },
     [](const Material&, const Pipeline& p) { return p.light_model.emission; }},
    {"occlusion_map", "The light model adds no emission, and the plane of both is not there",
     [](const Material& m) { return m.occlusion_map.used(); },
     [](const Material&, const Pipeline& p) { return p.light_model.emission; }},
    {"occlusion_strength", "The material has no occlusion_map",
     [](const Material& m) { return m.occlusion_strength != default_material().occlusion_strength; },
     [](const Material& m, const Pipeline&) { return m.occlusion_map.used(); }},
    {"unlit", "The pipeline lights every surface that is drawn like this one",
     [](const Material& m) { return m.unlit; }, [](const Material& m, const Pipeline& p) { return drawn_unlit(m, p); }},
    {"transparent", "The transparency of the pipeline is 'none', so the material is drawn as an opaque one",
     [](const Material& m) { return m.transparent; },
     [](const Material&, const Pipeline& p) { return p.transparency.mode != TransparencyMode::none; }},
    {"color", "The alpha of an opaque material without alpha_cutoff reaches no stage of the pipeline",
     [](const Material& m) { return m.base_color.a != 1.0f && !m.transparent; },
     [](const Material& m, const Pipeline& p) {
       return m.masked() || blends_transparent(m, p) || p.light_model.alpha_from_albedo;
     }}};

template <typename T, size_t kFields>
void append_ignored(std::string_view of, const Field<T> (&fields)[kFields], std::span<const T> values,
                    const Pipeline& pipeline, std::vector<IgnoredField>& ignored) {
  for (const Field<T>& field : fields) {
    const auto count = std::count_if(values.begin(), values.end(), [&](const T& value) {
      return field.stated(value) && !field.read(value, pipeline);
    });
    if (count > 0) ignored.push_back({of, field.key, field.reason, uint64_t(count)});
  }
}

/// Whether a map that is read has no texture coordinates in the mesh.
bool lacks_uv_of_maps(const Mesh& mesh, const Material& m, const Pipeline& pipeline) {
  const MaterialValues v = material_values(m, pipeline);
  const auto lacks = [&](const TextureSlot& slot, bool read) {
    return read && slot.used() && mesh.uv_set(slot.uv_set)[0].empty();
  };
  return lacks(m.color_map, true) || lacks(m.normal_map, true) || lacks(m.specular_map, v.specular_map) ||
         lacks(m.metallic_roughness_map, v.metallic_roughness_map) || lacks(m.emission_map, v.emission_map) ||
         lacks(m.occlusion_map, v.occlusion_map);
}

/// Takes the maps of materials whose meshes have no texture coordinates as one field.
void append_maps_without_uv(const Scene& scene, const Pipeline& pipeline, std::vector<IgnoredField>& ignored) {
  std::vector<bool> lacks_uv(scene.materials.size(), false);
  for (const Instance& instance : scene.instances)
    if (lacks_uv_of_maps(scene.meshes[instance.mesh], scene.materials[instance.material], pipeline))
      lacks_uv[instance.material] = true;
  const auto count = std::count(lacks_uv.begin(), lacks_uv.end(), true);
  if (count > 0)
    ignored.push_back({"material", "maps", "A mesh has no texture coordinates, so its maps are read at u = v = 0 alone",
                       uint64_t(count)});
}

/// Occlusion maps that are read, and hold nothing off.
void append_needless_occlusion(const Scene& scene, const Pipeline& pipeline, std::vector<IgnoredField>& ignored) {
  if (!pipeline.light_model.emission || has_ambient_light(scene, pipeline.light_model)) return;
  const auto count = std::count_if(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& m) { return m.occlusion_map.used(); });
  if (count > 0)
    ignored.push_back({"material", "occlusion_map",
                       "It holds off ambient light alone, and neither the light model nor a light has any",
                       uint64_t(count)});
}

/// Range and attenuation of a built-in scene are two descriptions of one falloff.
bool is_other_description(const IgnoredField& field, const Pipeline& pipeline) {
  const Falloff falloff = pipeline.light_model.falloff;
  return (field.field == "range" && reads_attenuation(falloff)) ||
         (field.field == "attenuation" && (reads_range(falloff) || falloff == Falloff::none));
}

/// Whether Trueshade made the lights: of a built-in scene, or about a geometry file alone.
bool has_lights_of_ours(const Scene& scene) { return scene.lights_of_ours || scene.spec.starts_with("builtin:"); }

}  // namespace

std::vector<IgnoredField> ignored_fields(const Scene& scene, const Pipeline& pipeline) {
  const FpScope fp;
  std::vector<IgnoredField> ignored;
  if (pipeline.view != ImageView::lit) return ignored;
  append_ignored<Light>("light", kIgnorableOfLights, scene.lights, pipeline, ignored);
  if (has_lights_of_ours(scene))
    std::erase_if(ignored, [&](const IgnoredField& field) { return is_other_description(field, pipeline); });
  append_ignored<Material>("material", kIgnorableOfMaterials, scene.materials, pipeline, ignored);
  append_needless_occlusion(scene, pipeline, ignored);
  append_maps_without_uv(scene, pipeline, ignored);
  return ignored;
}

uint64_t implausible_reflectances(const Scene& scene) {
  const FpScope fp;
  const auto too_bright = [](const glm::vec3& color) {
    return std::max(std::max(color.r, color.g), color.b) > kLargestPlausibleReflectance;
  };
  return uint64_t(std::count_if(scene.materials.begin(), scene.materials.end(), [&](const Material& m) {
    return too_bright(glm::vec3(m.base_color)) || too_bright(m.specular_color);
  }));
}

}  // namespace trueshade
