// The light passes of the strategies as GLSL: what is drawn over the scene again, or as the geometry of lights.
#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

std::string lights_text(const Pipeline& p, const GlslOptions& options) {
  return "layout(location = 0) out vec4 target;\n\n" + light_function_text(p.light_model, options) +
         (limits_range(p).any() ? "\n" + extent_text(p, "lights") : "") + "\nvoid main() {\n";
}

std::string loop_text(const Pipeline& p) { return light_loop_text(p, "lights", "0", "light_count") + "}\n"; }

/// The surface of a fragment of the scene itself.
std::string forward_surface_text(const Pipeline& p, const GlslOptions& options) {
  return "  vec3 P = world_position;\n  vec3 stored_normal = " + normal_text(p, options) + ";\n" +
         material_text(p.light_model, options) + surface_text(p.light_model);
}

std::string forward_text(const Pipeline& p, const GlslOptions& options) {
  const bool loop = p.strategy == Strategy::forward_loop;
  std::string text = glsl_header(options.version, loop ? "the scene, all lights summed in order, one store a fragment"
                                                       : "the scene under one light, added to the target");
  text += varyings_text(p, options, "in") + viewer_text(p.light_model) + "uniform samplerBuffer lights;\n";
  text += loop ? "uniform int light_count;\n" : "uniform int light;  // the draw's; -1: a scene without lights\n";
  if (reads_materials(p.light_model)) text += "uniform samplerBuffer materials;\n";
  text += lights_text(p, options) + forward_surface_text(p, options);
  if (loop) return text + loop_text(p);
  text += "  vec3 sum = light <= 0 ? " + sum_start_text(p.light_model) +
          " : vec3(0.0);\n  if (light >= 0) sum += " + bounded_call_text(p, "lights", "light") + ";\n";
  return text + target_text(p.light_model, "sum") + "}\n";
}

std::string volume_vertex_text(const GlslOptions& options) {
  return glsl_header(options.version, "the geometry of one light: a mesh in the world, or a quad over the image") +
         R"(layout(location = 0) in vec3 corner;
uniform vec4 clip_from_world[4];  // rows, rounded once from double
uniform int mesh;                 // 0: a quad, corners in normalized device coordinates
)" + (options.version >= 400 ? "precise gl_Position;\n" : "") +
         R"(
float affine(vec4 row, vec3 p) { return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w; }

void main() {
  gl_Position = mesh == 0 ? vec4(corner.xy, 0.0, 1.0)
                          : vec4(affine(clip_from_world[0], corner), affine(clip_from_world[1], corner),
                                 affine(clip_from_world[2], corner), affine(clip_from_world[3], corner));
}
)";
}

std::string volume_fragment_text(const Pipeline& p, const GlslOptions& options) {
  std::string text = glsl_header(options.version, "one light over the G-buffer, blended into the target");
  text += surface_uniforms_text(p, options) + "uniform samplerBuffer lights;\nuniform int light;  // the draw's\n";
  text += lights_text(p, options) + read_surface_text(p, options);
  if (limits_range(p).any()) text += "  if (!in_extent(P, light)) discard;\n";
  return text + target_text(p.light_model, lit_call_text(p.light_model, "lights", "light")) + "}\n";
}

std::string base_text(const Pipeline& p, const GlslOptions& options) {
  const std::string unit =
      "vec3 unit(vec3 v) {\n  float l2 = dot(v, v);\n  return v * (l2 > 0.0 ? inversesqrt(l2) : 0.0);\n}\n";
  return glsl_header(options.version, "what a surface has without lights") + surface_uniforms_text(p, options) +
         "layout(location = 0) out vec4 target;\n\n" + unit + "\nvoid main() {\n" + read_surface_text(p, options) +
         target_text(p.light_model, sum_start_text(p.light_model)) + "}\n";
}

std::string deferred_loop_text(const Pipeline& p, const GlslOptions& options) {
  std::string text = glsl_header(options.version, "light pass: sums all lights in order, one store a pixel");
  text += surface_uniforms_text(p, options);
  text += "uniform samplerBuffer lights;  // " + std::to_string(LightLayout(p.light_model).texels()) +
          " texels a light\nuniform int light_count;\n";
  return text + lights_text(p, options) + read_surface_text(p, options) + loop_text(p);
}

}  // namespace

bool ends_at_range(Falloff falloff) { return falloff == Falloff::linear_range || falloff == Falloff::inverse_square; }

RangeLimits limits_range(const Pipeline& p) {
  const auto limited = [&](LightExtent extent) {
    return extent != LightExtent::unbounded &&
           !(p.strategy == Strategy::deferred_volumes && extent >= LightExtent::box);
  };
  if (ends_at_range(p.light_model.falloff) && p.strategy != Strategy::deferred_volumes) return {};
  return {limited(p.light_volumes.point), limited(p.light_volumes.spot)};
}

std::string extent_text(const Pipeline& p, const std::string& buffer) {
  const RangeLimits limits = limits_range(p);
  const std::string n = std::to_string(LightLayout(p.light_model).texels());
  const char* free = !limits.point ? "place.w < 2.5" : !limits.spot ? "place.w != 2.0" : "place.w < 2.0";
  return "bool in_extent(vec3 P, int light) {\n  vec4 place = texelFetch(" + buffer + ", " + n +
         " * light);\n  return " + free + " || distance(place.xyz, P) < texelFetch(" + buffer + ", " + n +
         " * light + 1).w;\n}\n";
}

std::string bounded_call_text(const Pipeline& p, const std::string& buffer, const std::string& light) {
  const std::string call = lit_call_text(p.light_model, buffer, light);
  return limits_range(p).any() ? "in_extent(P, " + light + ") ? " + call + " : vec3(0.0)" : call;
}

std::string light_loop_text(const Pipeline& p, const std::string& buffer, const std::string& first,
                            const std::string& end) {
  return "  vec3 sum = " + sum_start_text(p.light_model) + ";\n  for (int i = " + first + "; i < " + end +
         "; ++i)\n    sum += " + bounded_call_text(p, buffer, "i") + ";\n" + target_text(p.light_model, "sum");
}

namespace {

void set_program_shaders(const Pipeline& p, const GlslOptions& options, GlslShaders& shaders) {
  using Kind = ProgramDraw::Kind;
  const std::string one = std::string("uniform int ") + kDrawnLight + ";  // the draw's; -1: a scene without lights\n";
  const auto text = [&](Kind kind, const char* what, const std::string& declared) {
    return program_fragment_text(p, options, {kind, std::string(what) + " by a light program", declared});
  };
  shaders.light_vert = is_forward(p.strategy) ? shaders.geometry_vert : fullscreen_vertex_text(options.version);
  switch (p.strategy) {
    case Strategy::forward_multipass:
      shaders.light_frag = text(Kind::pass, "the scene under one light, added to the target", one);
      break;
    case Strategy::forward_loop:
      shaders.light_frag = text(Kind::sum, "the scene, all lights summed in order", "");
      break;
    case Strategy::deferred_volumes:
      shaders.light_vert = volume_vertex_text(options);
      shaders.light_frag = text(Kind::light, "one light over the G-buffer, blended into the target", one);
      if (p.light_volumes.base) shaders.base_frag = text(Kind::base, "what a surface has without lights", "");
      break;
    case Strategy::deferred_loop:
      shaders.light_frag = text(Kind::sum, "light pass: sums all lights in order, one store a pixel", "");
      break;
  }
}

}  // namespace

void set_light_shaders(const Pipeline& pipeline, const GlslOptions& options, GlslShaders& shaders) {
  if (pipeline.light_program.used()) return set_program_shaders(pipeline, options, shaders);
  switch (pipeline.strategy) {
    case Strategy::forward_multipass:
    case Strategy::forward_loop:
      shaders.light_vert = shaders.geometry_vert;
      shaders.light_frag = forward_text(pipeline, options);
      break;
    case Strategy::deferred_volumes:
      shaders.light_vert = volume_vertex_text(options);
      shaders.light_frag = volume_fragment_text(pipeline, options);
      if (pipeline.light_volumes.base) shaders.base_frag = base_text(pipeline, options);
      break;
    case Strategy::deferred_loop:
      shaders.light_vert = fullscreen_vertex_text(options.version);
      shaders.light_frag = deferred_loop_text(pipeline, options);
      break;
  }
}

}  // namespace trueshade::oracle
