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
flat out ivec2 tile_lights;  // first and end, in lights of the buffer

void main() {
  int first = int(texelFetch(tiles, 2 * gl_InstanceID).x);
  tile_lights = ivec2(first, first + int(texelFetch(tiles, 2 * gl_InstanceID + 1).x));
  ivec2 tile = ivec2(gl_InstanceID % columns, gl_InstanceID / columns) + ivec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(vec2(tile * tile_size) / image_size * 2.0 - 1.0, 0.0, 1.0);
}
)";
}

constexpr const char* kTileOfFragment =
    "  ivec2 tile = ivec2(gl_FragCoord.xy) / tile_size;\n  int at = 2 * (tile.y * columns + tile.x);\n"
    "  int first = int(texelFetch(tiles, at).x), end = first + int(texelFetch(tiles, at + 1).x);\n";

/// The draw of a design, whose lights' records are in the buffer `lights`.
LightDraw light_draw(GlDesign design) {
  using Kind = LightDraw::Kind;
  const std::string what = "lights of the design " + std::string(name_of(design));
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

}  // namespace

DesignShaders lighting_shaders(const Pipeline& p, const GlslOptions& options, GlDesign design) {
  const std::string frag = light_fragment_text(p, options, light_draw(design));
  if (is_forward(design)) return {vertex_text(p, options), frag};
  if (design == GlDesign::deferred_volumes) return {volume_vertex_text(options.version), frag};
  if (is_tiled(design)) return {tile_vertex_text(options.version), frag};
  return {fullscreen_vertex_text(options.version), frag};
}

std::string base_fragment_text(const Pipeline& p, const GlslOptions& options) {
  return light_fragment_text(p, options, {LightDraw::Kind::base, "what a surface has without lights"});
}

std::string empty_fragment_text(int version) { return glsl_header(version, "depth alone") + "void main() {}\n"; }

}  // namespace trueshade::oracle
