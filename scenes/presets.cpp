#include "scenes/presets.h"

#include <array>

namespace trueshade {
namespace {

Preset many_lights() {
  return {"many-lights",
          "Trueshade's own: Blinn-Phong with a linear window, as in light-volume renderers "
          "(max(0, 1 - d/range) * max(0, N.L)), over an rgba8 albedo plane",
          Pipeline{}};
}

Preset touchdesigner() {
  Pipeline p;
  p.preset = "touchdesigner";
  p.gbuffer.albedo.format = Format::rgba32f;
  p.light_model.renormalize = false;      // the shader uses the texel as it was stored
  p.light_model.specular_masked = false;  // the seed adds the specular term whatever N.L is
  p.light_model.shininess = 32.0f;
  p.light_model.specular_color = glm::vec3(0.5f);
  p.light_model.falloff = Falloff::quadratic;
  p.light_model.order = TermOrder::separate;
  p.light_model.alpha_from_albedo = true;
  p.target = Format::rgba8;
  return {"touchdesigner", "TouchDesigner Deferred Lighting - Point Lights (tutorial), its combine shader", p};
}

Preset gl_fixed() {
  Pipeline p;
  p.preset = "gl-fixed";
  LightModel& m = p.light_model;
  m.falloff = Falloff::attenuation;
  m.cone = Cone::exponent;
  m.order = TermOrder::with_ambient;
  m.specular_source = SpecularSource::material;
  m.viewer = Viewer::infinite;  // LIGHT_MODEL_LOCAL_VIEWER is false at first
  m.emission = true;
  m.global_ambient = glm::vec3(0.2f);  // LIGHT_MODEL_AMBIENT at first
  m.clamp_result = true;
  m.alpha_from_albedo = true;
  return {"gl-fixed",
          "The OpenGL Graphics System, version 4.6 (compatibility profile), 12.2.1 Lighting, evaluated per fragment, "
          "with GL_NORMALIZE and GL_COLOR_MATERIAL for ambient and diffuse",
          p};
}

Preset punctual() {
  Pipeline p;
  p.preset = "punctual";
  p.gbuffer.albedo.format = Format::rgba32f;
  p.light_model.falloff = Falloff::inverse_square;
  p.light_model.cone = Cone::squared_penumbra;
  p.light_model.specular_source = SpecularSource::metallic_roughness;
  p.target = Format::rgba16f;
  return {"punctual",
          "glTF 2.0 extension KHR_lights_punctual (range and cone attenuation, candela and lux), metallic-roughness "
          "materials mapped to Blinn-Phong",
          p};
}

}  // namespace

std::span<const Preset> presets() {
  static const std::array<Preset, 4> rows{many_lights(), touchdesigner(), gl_fixed(), punctual()};
  return rows;
}

std::optional<Pipeline> preset_pipeline(std::string_view name) {
  for (const Preset& row : presets())
    if (row.name == name) return row.pipeline;
  return std::nullopt;
}

}  // namespace trueshade
