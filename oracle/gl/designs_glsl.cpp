#include "oracle/gl/designs_glsl.h"

namespace trueshade::oracle {

namespace {

std::string loop_text(const LightModel& model, const std::string& buffer, const std::string& first,
                      const std::string& end) {
  return "  vec3 sum = " + sum_start_text(model) + ";\n  for (int i = " + first + "; i < " + end +
         "; ++i)\n    sum += " + lit_call_text(model, buffer, "i") + ";\n" + target_text(model, "sum");
}

/// A box around each light's range, a light an instance; over the whole image where the range does not bound it.
std::string box_vertex_text(const LightModel& model, int version) {
  const std::string n = std::to_string(LightLayout(model).texels());
  const bool bounded = model.falloff == Falloff::linear_range;
  return glsl_header(version,
                     "light volumes: axis-aligned boxes, corners bit x, y, z, counter-clockwise from outside") +
         R"(uniform samplerBuffer lights;
uniform mat4 clip_from_world;
flat out int light;
const int corners[36] = int[](0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                              2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6);

void main() {
  light = gl_InstanceID;
  vec4 place = texelFetch(lights, )" +
         n + R"( * light);
  float range = texelFetch(lights, )" +
         n + R"( * light + 1).w;
  int c = corners[gl_VertexID];
  vec3 corner = place.xyz + range * (2.0 * vec3(c & 1, (c >> 1) & 1, c >> 2) - 1.0);
  gl_Position = clip_from_world * vec4(corner, 1.0);
  // Back-facing over the whole image, and nothing of the other triangles.
  if ()" +
         (bounded ? "place.w < 2.0 || isinf(range)" : "true") + R"()
    gl_Position = gl_VertexID == 0 ? vec4(-1.0, -1.0, 0.0, 1.0) : gl_VertexID == 1 ? vec4(-1.0, 3.0, 0.0, 1.0)
                : gl_VertexID == 2 ? vec4(3.0, -1.0, 0.0, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
)";
}

/// A rectangle a tile, an instance each, that carries where its lights are.
std::string tile_vertex_text(int version) {
  return glsl_header(version, "tiles: 4 vertices and an instance each, as a strip") + R"(uniform usamplerBuffer tiles;
uniform int tile_size;
uniform int columns;
uniform vec2 image_size;
flat out ivec2 range;  // first and end, in lights of `records`

void main() {
  int first = int(texelFetch(tiles, 2 * gl_InstanceID).x);
  range = ivec2(first, first + int(texelFetch(tiles, 2 * gl_InstanceID + 1).x));
  ivec2 tile = ivec2(gl_InstanceID % columns, gl_InstanceID / columns) + ivec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(vec2(tile * tile_size) / image_size * 2.0 - 1.0, 0.0, 1.0);
}
)";
}

std::string deferred_fragment_text(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  const LightModel& model = p.light_model;
  std::string text = glsl_header(options.version, "lights of the design " + std::string(name_of(design)));
  text += surface_uniforms_text(p, options);
  if (design == GlDesign::tiled) text += "uniform samplerBuffer records;\nflat in ivec2 range;\n";
  if (design == GlDesign::deferred_volumes) text += "uniform samplerBuffer lights;\nflat in int light;\n";
  if (design == GlDesign::deferred_loop) text += "uniform samplerBuffer lights;\nuniform int light_count;\n";
  text += "layout(location = 0) out vec4 target;\n\n" + light_function_text(model, options) + "\nvoid main() {\n" +
          read_surface_text(p, options);
  if (design == GlDesign::tiled) text += loop_text(model, "records", "range.x", "range.y");
  if (design == GlDesign::deferred_volumes)
    text += "  target = vec4(" + lit_call_text(model, "lights", "light") +
            (model.order == TermOrder::albedo_last ? " * albedo.rgb, 0.0);\n" : ", 0.0);\n");
  if (design == GlDesign::deferred_loop) text += loop_text(model, "lights", "0", "light_count");
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
  text += "layout(location = 0) out vec4 target;\n\n" + light_function_text(model, options) +
          "\nvoid main() {\n  vec3 P = world_position;\n  vec3 stored_normal = world_normal;\n" +
          material_text(model, options) + surface_text(model);
  if (design == GlDesign::forward_plus)
    text +=
        "  ivec2 tile = ivec2(gl_FragCoord.xy) / tile_size;\n  int at = 2 * (tile.y * columns + tile.x);\n"
        "  int first = int(texelFetch(tiles, at).x), end = first + int(texelFetch(tiles, at + 1).x);\n" +
        loop_text(model, "records", "first", "end");
  if (design == GlDesign::forward_loop) text += loop_text(model, "lights", "0", "light_count");
  if (design == GlDesign::forward_multipass)
    text += target_text(model, "(light <= 0 ? " + sum_start_text(model) + " : vec3(0.0)) + (light < 0 ? vec3(0.0) : " +
                                   lit_call_text(model, "lights", "light") + ")");
  return text + "}\n";
}

}  // namespace

Pipeline design_pipeline(const Pipeline& pipeline, GlDesign design) {
  Pipeline p = pipeline;
  if (design == GlDesign::tiled) {
    p.gbuffer.position_from_depth = true;
    p.gbuffer.normal.format = Format::rgba16f;
  }
  if (is_forward(design)) p.gbuffer.position_from_depth = false;
  return p;
}

DesignShaders lighting_shaders(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  if (is_forward(design)) return {vertex_text(p, options), forward_fragment_text(p, options, design)};
  const std::string frag = deferred_fragment_text(p, options, design);
  if (design == GlDesign::deferred_volumes) return {box_vertex_text(p.light_model, options.version), frag};
  if (design == GlDesign::tiled) return {tile_vertex_text(options.version), frag};
  return {fullscreen_vertex_text(options.version), frag};
}

std::string base_fragment_text(const Pipeline& p, const GlslOptions& options) {
  return glsl_header(options.version, "black where there is a surface") + surface_uniforms_text(p, options) +
         "layout(location = 0) out vec4 target;\n"
         "vec3 unit(vec3 v) { return v; }  // what comes of it is not used\n\nvoid main() {\n" +
         read_surface_text(p, options) + target_text(p.light_model, sum_start_text(p.light_model)) + "}\n";
}

std::string empty_fragment_text(int version) { return glsl_header(version, "depth alone") + "void main() {}\n"; }

}  // namespace trueshade::oracle
