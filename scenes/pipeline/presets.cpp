#include "scenes/pipeline/presets.h"

#include <algorithm>
#include <array>

#include "core/fp_env.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"

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
  p.light_model.emission = true;
  p.target = Format::rgba16f;
  return {"punctual",
          "glTF 2.0 extension KHR_lights_punctual (range and cone attenuation, candela and lux), metallic-roughness "
          "materials mapped to Blinn-Phong",
          p};
}

Preset lecture() {
  Pipeline p;
  p.preset = "lecture";
  p.gbuffer.albedo.format = Format::rgba32f;
  LightModel& m = p.light_model;
  m.falloff = Falloff::none;
  m.cone = Cone::smooth_cutoff;
  m.specular = Specular::none;
  m.order = TermOrder::albedo_last;  // e is summed, the albedo multiplies it once
  m.alpha_from_albedo = true;
  p.strategy = Strategy::forward_loop;
  return {"lecture", "Lecture notes on lights for rasterization: forward multi-pass, forward light loop, deferred", p};
}

Preset light_volumes() {
  Pipeline p;
  p.preset = "light-volumes";
  p.light_model.renormalize = false;
  p.light_model.specular = Specular::none;
  p.light_volumes.point = p.light_volumes.spot = LightExtent::box;
  p.light_volumes.cull_face = CullFace::front;  // a box is drawn though the eye is inside
  p.strategy = Strategy::deferred_volumes;
  return {"light-volumes",
          "A paper on deferred rendering with light volumes after Thaler (2010): its formula as meant, boxes about the "
          "lights, glBlendFunc(GL_ONE, GL_ONE)",
          p};
}

Preset light_volumes_literal() {
  Pipeline p = light_volumes().pipeline;
  p.preset = "light-volumes-literal";
  p.light_model.falloff = Falloff::linear;
  p.light_model.diffuse = Diffuse::unclamped;
  return {"light-volumes-literal", "The same paper, its formula as printed: nothing is clamped", p};
}

Preset redsdk() {
  Pipeline p;
  p.preset = "redsdk";
  for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo, &p.gbuffer.uv})
    plane->format = Format::rgb16f;
  LightModel& m = p.light_model;
  m.falloff = Falloff::none;
  m.cone = Cone::smooth_penumbra;
  m.specular = Specular::phong;
  m.specular_source = SpecularSource::albedo;
  m.specular_masked = false;
  m.shininess = 60.0f;
  p.light_volumes.point = LightExtent::sphere;
  p.light_volumes.spot = LightExtent::cone;
  p.light_volumes.cull_face = CullFace::back;
  p.strategy = Strategy::deferred_volumes;
  return {"redsdk", "REDsdk tutorial: Deferred shading using multiple render targets", p};
}

Preset gltf() {
  Pipeline p = punctual().pipeline;  // its light model reads the same fields of lights and materials
  p.preset = "gltf";
  p.light_program = shipped_program("gltf");
  end_at_range(p.light_volumes);
  return {"gltf",
          "glTF 2.0, appendix B: metals and plastics by GGX, under KHR_lights_punctual; draws by the light model gltf",
          p};
}

Pipeline with_back_faces_culled(std::string_view name) {
  Pipeline pipeline = preset_pipeline(name).value();
  pipeline.geometry.cull_face = CullFace::back;  // glTF 2.0, "Double Sided"
  return pipeline;
}

Pipeline with_lights_of_area(Pipeline pipeline) {
  pipeline.light_program = shipped_program("area");
  return pipeline;
}

}  // namespace

std::span<const Preset> presets() {
  const FpScope fp;
  static const std::array<Preset, 9> rows{many_lights(),   touchdesigner(),         gl_fixed(), punctual(), lecture(),
                                          light_volumes(), light_volumes_literal(), redsdk(),   gltf()};
  return rows;
}

bool draws_light_programs() {
#ifdef TRUESHADE_LIGHT_PROGRAMS
  return true;
#else
  return false;
#endif
}

const Pipeline& default_pipeline(const Scene& scene, bool by_program) {
  const FpScope fp;
  static const Pipeline program = with_back_faces_culled("gltf"), formula = with_back_faces_culled("punctual");
  static const Pipeline areas = with_lights_of_area(preset_pipeline("gltf").value()),
                        photometric_areas = with_lights_of_area(program);
  if (by_program &&
      std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return has_area(l.type); }))
    return scene.photometric ? photometric_areas : areas;
  if (!scene.photometric) return presets().front().pipeline;
  return by_program ? program : formula;
}

bool draws_by_its_preset(const Pipeline& pipeline) {
  const std::optional<Pipeline> row = preset_pipeline(pipeline.preset);
  return row && row->light_program == pipeline.light_program;
}

std::optional<Pipeline> preset_pipeline(std::string_view name) {
  const FpScope fp;
  for (const Preset& row : presets())
    if (row.name == name) return row.pipeline;
  return std::nullopt;
}

}  // namespace trueshade
