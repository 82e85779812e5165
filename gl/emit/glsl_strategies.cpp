// The light passes of the strategies as GLSL: what is drawn over the scene again, or as the geometry of lights.
#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

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

}  // namespace

bool ends_at_range(Falloff falloff) { return falloff == Falloff::linear_range || falloff == Falloff::inverse_square; }

RangeLimits limits_range(const Pipeline& p) {
  const auto limited = [&](LightExtent extent) {
    return extent != LightExtent::unbounded &&
           !(p.strategy == Strategy::deferred_volumes && extent >= LightExtent::box);
  };
  if (ends_at_range(p.light_model.falloff) && p.strategy != Strategy::deferred_volumes) return {};
  return {limited(p.light_volumes.point), limited(p.light_volumes.spot)};  // all around, to one side
}

void set_light_shaders(const Pipeline& p, const GlslOptions& options, GlslShaders& shaders) {
  using Kind = LightDraw::Kind;
  const std::string one = std::string("uniform int ") + kDrawnLight + ";  // the draw's; -1: a scene without lights\n";
  const auto text = [&](Kind kind, const char* what, const std::string& declared) {
    return light_fragment_text(p, options, {kind, what, declared});
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

}  // namespace trueshade::oracle
