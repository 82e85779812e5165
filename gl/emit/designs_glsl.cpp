#include "gl/emit/designs_glsl.h"

#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

/// Light geometry of make_volume_batches(): every vertex knows its light.
std::string volume_vertex_text(int version) {
  return glsl_header(version, "light volumes, many lights a draw: meshes in the world, or quads over the image") +
         R"(layout(location = 0) in vec3 corner;
layout(location = 1) in int owner;
uniform mat4 clip_columns;  // from the world
uniform int mesh;  // 0: quads, corners in normalized device coordinates
flat out int drawn_light;

void main() {
  drawn_light = owner;
  gl_Position = mesh == 0 ? vec4(corner.xy, 0.0, 1.0) : clip_columns * vec4(corner, 1.0);
}
)";
}

/// A rectangle a tile, an instance each, that carries where its lights are.
std::string tile_vertex_text(int version) {
  return glsl_header(version, "tiles: 4 vertices and an instance each, as a strip") + R"(uniform usamplerBuffer tiles;
uniform int tile_size;
uniform int columns;
uniform vec2 image_size;
flat out ivec2 tile_lights;  // first and end, in lights of `records`

void main() {
  int first = int(texelFetch(tiles, 2 * gl_InstanceID).x);
  tile_lights = ivec2(first, first + int(texelFetch(tiles, 2 * gl_InstanceID + 1).x));
  ivec2 tile = ivec2(gl_InstanceID % columns, gl_InstanceID / columns) + ivec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(vec2(tile * tile_size) / image_size * 2.0 - 1.0, 0.0, 1.0);
}
)";
}

std::string lights_text(const Pipeline& p, const GlslOptions& options, const std::string& buffer) {
  return "layout(location = 0) out vec4 target;\n\n" + light_function_text(p.light_model, options) +
         (limits_range(p).any() ? "\n" + extent_text(p, buffer) : "") + "\nvoid main() {\n";
}

constexpr const char* kTileOfFragment =
    "  ivec2 tile = ivec2(gl_FragCoord.xy) / tile_size;\n  int at = 2 * (tile.y * columns + tile.x);\n"
    "  int first = int(texelFetch(tiles, at).x), end = first + int(texelFetch(tiles, at + 1).x);\n";

/// The draw of a design under a light program, whose records are in the buffer `lights`.
ProgramDraw program_draw(GlDesign design) {
  using Kind = ProgramDraw::Kind;
  const std::string what = "a light program in the design " + std::string(name_of(design));
  switch (design) {
    case GlDesign::deferred_volumes:
      return {Kind::light, what, "flat in int drawn_light;\n"};
    case GlDesign::tiled:
    case GlDesign::tiled_thin:
      return {Kind::sum, what, "flat in ivec2 tile_lights;\n", "", "tile_lights.x", "tile_lights.y"};
    case GlDesign::forward_plus:
      return {Kind::sum,       what,    "uniform usamplerBuffer tiles;\nuniform int tile_size;\nuniform int columns;\n",
              kTileOfFragment, "first", "end"};
    case GlDesign::forward_multipass:
      return {Kind::pass, what, "uniform int drawn_light;  // -1: none, for a scene without lights\n"};
    case GlDesign::deferred_loop:
    case GlDesign::forward_loop:
      break;
  }
  return {Kind::sum, what};
}

std::string deferred_fragment_text(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  const LightModel& model = p.light_model;
  std::string text = glsl_header(options.version, "lights of the design " + std::string(name_of(design)));
  text += surface_uniforms_text(p, options);
  if (is_tiled(design)) text += "uniform samplerBuffer records;\nflat in ivec2 tile_lights;\n";
  if (design == GlDesign::deferred_volumes) text += "uniform samplerBuffer lights;\nflat in int drawn_light;\n";
  if (design == GlDesign::deferred_loop) text += "uniform samplerBuffer lights;\nuniform int light_count;\n";
  text += lights_text(p, options, is_tiled(design) ? "records" : "lights") + read_surface_text(p, options);
  if (is_tiled(design)) text += light_loop_text(p, "records", "tile_lights.x", "tile_lights.y");
  if (design == GlDesign::deferred_volumes)
    text += (limits_range(p).any() ? "  if (!in_extent(P, drawn_light)) discard;\n" : "") +
            target_text(model, lit_call_text(model, "lights", kDrawnLight));
  if (design == GlDesign::deferred_loop) text += light_loop_text(p, "lights", "0", "light_count");
  return text + "}\n";
}

std::string forward_fragment_text(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  const LightModel& model = p.light_model;
  std::string text = glsl_header(options.version, "surface and lights of the design " + std::string(name_of(design)));
  text += varyings_text(p, options, "in") + "uniform vec3 eye;\n";
  if (model.viewer == Viewer::infinite) text += "uniform vec3 view_axis;\n";
  if (reads_materials(model)) text += "uniform samplerBuffer materials;\n";
  if (design == GlDesign::forward_plus)
    text +=
        "uniform samplerBuffer records;\nuniform usamplerBuffer tiles;\nuniform int tile_size;\nuniform int columns;\n";
  else
    text += "uniform samplerBuffer lights;\n";
  if (design == GlDesign::forward_loop) text += "uniform int light_count;\n";
  if (design == GlDesign::forward_multipass) text += "uniform int light;  // -1: none, for a scene without lights\n";
  text += lights_text(p, options, design == GlDesign::forward_plus ? "records" : "lights") +
          "  vec3 P = world_position;\n  vec3 stored_normal = " + normal_text(p, options) + ";\n" +
          material_text(model, options) + surface_text(model);
  if (design == GlDesign::forward_plus) text += kTileOfFragment + light_loop_text(p, "records", "first", "end");
  if (design == GlDesign::forward_loop) text += light_loop_text(p, "lights", "0", "light_count");
  if (design == GlDesign::forward_multipass)
    text += target_text(model, "(light <= 0 ? " + sum_start_text(model) + " : vec3(0.0)) + (light < 0 ? vec3(0.0) : " +
                                   bounded_call_text(p, "lights", "light") + ")");
  return text + "}\n";
}

}  // namespace

DesignShaders lighting_shaders(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  const std::string frag = p.light_program.used() ? program_fragment_text(p, options, program_draw(design))
                           : is_forward(design)   ? forward_fragment_text(p, options, design)
                                                  : deferred_fragment_text(p, options, design);
  if (is_forward(design)) return {vertex_text(p, options), frag};
  if (design == GlDesign::deferred_volumes) return {volume_vertex_text(options.version), frag};
  if (is_tiled(design)) return {tile_vertex_text(options.version), frag};
  return {fullscreen_vertex_text(options.version), frag};
}

std::string base_fragment_text(const Pipeline& p, const GlslOptions& options) {
  if (p.light_program.used())
    return program_fragment_text(p, options, {ProgramDraw::Kind::base, "what a surface has without lights"});
  return glsl_header(options.version, "black where there is a surface") + surface_uniforms_text(p, options) +
         "layout(location = 0) out vec4 target;\n"
         "vec3 unit(vec3 v) { return v; }  // what comes of it is not used\n\nvoid main() {\n" +
         read_surface_text(p, options) + target_text(p.light_model, sum_start_text(p.light_model)) + "}\n";
}

std::string empty_fragment_text(int version) { return glsl_header(version, "depth alone") + "void main() {}\n"; }

}  // namespace trueshade::oracle
