#include "gl/emit/glsl.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <utility>

#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

std::string qualifier(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::smooth:
      return "smooth";
    case Interpolation::flat:
      return "flat";
    case Interpolation::noperspective:
      return "noperspective";
  }
  return {};
}

constexpr size_t kMostPlanes = 8;  // GL_MAX_DRAW_BUFFERS, at least

bool reads_specular_map(const LightModel& model, const GlslOptions& options) {
  return options.specular_maps && takes_gloss(model);
}

/// The maps that a fragment's material is made of beside its colour.
std::vector<std::string> material_maps(const LightModel& model, const GlslOptions& options) {
  std::vector<std::string> names;
  if (reads_specular_map(model, options)) names.emplace_back("specular");
  if (options.metal_maps && maps_metals(model)) names.emplace_back("metallic_roughness");
  if (options.emission_maps && model.emission) names.emplace_back("emission");
  if (options.occlusion_maps && model.emission) names.emplace_back("occlusion");
  return names;
}

/// The maps whose texture coordinates have a varying each; the others share `texcoord`.
std::vector<std::string> maps_with_own_uv(const GlslOptions& options) {
  if (!options.more_uv) return {};
  std::vector<std::string> maps{"color"};
  if (options.specular_maps) maps.emplace_back("specular");
  if (options.normal_maps) maps.emplace_back("normal");
  if (options.metal_maps) maps.emplace_back("metallic_roughness");
  if (options.emission_maps) maps.emplace_back("emission");
  if (options.occlusion_maps) maps.emplace_back("occlusion");
  return maps;
}

/// The texel of a map.
std::string lookup_text(const std::string& map, const GlslOptions& options) {
  return "texture(" + map + "_map, " + (options.more_uv ? map + "_texcoord" : "texcoord") + ")";
}

/// What a vertex shader reads of texture coordinates beside the first set: their texels, and which set each map reads.
std::string more_uv_text(const GlslOptions& options) {
  if (!options.more_uv) return {};
  std::string text = "uniform samplerBuffer more_uv;  // five texels a vertex: u and v of the sets behind the first\n";
  for (const std::string& map : maps_with_own_uv(options)) text += "uniform int " + map + "_uv_set;\n";
  return text +
         "vec2 uv_of(int set) { return set == 0 ? vertex_uv : texelFetch(more_uv, gl_VertexID * 5 + set - 1).xy; }\n";
}

bool has_ids(const std::vector<GlslPlane>& planes) {
  return std::any_of(planes.begin(), planes.end(), [](const GlslPlane& p) { return p.format == Format::r32ui; });
}

/// Whether fragments know their object and material.
bool carries_ids(const Pipeline& pipeline, const GlslOptions& options) {
  const ProgramReads reads = surface_reads(pipeline, options);
  return reads_materials(pipeline.light_model) || reads.object || reads.material ||
         has_ids(planes_of(pipeline, options));
}

/// Fixed-point planes hold directions as (n + 1) / 2.
bool halves_normals(const Pipeline& pipeline) {
  return info(pipeline.gbuffer.normal.format).number_class == NumberClass::unorm;
}

/// Whether fragments have a varying of the first set of texture coordinates.
bool carries_uv(const Pipeline& pipeline, const GlslOptions& options) {
  return options.uv || options.maps || surface_reads(pipeline, options).uv;
}

/// What a texel of a map does to the material's own values.
std::string map_text(const std::string& name, const LightModel& model, const GlslOptions& options) {
  const std::string texel = lookup_text(name, options);
  if (name == "specular") return "  gloss.rgb = gloss.rgb * " + texel + ".rgb;\n";
  if (name == "emission") return "  emission.rgb = emission.rgb * " + texel + ".rgb;\n";
  if (name == "occlusion") return "  emission.a = 1.0 + other.y * (" + texel + ".r - 1.0);\n";
  if (model.keeps_metals) return "  gloss.rg = gloss.rg * " + texel + ".bg;\n";
  return "  vec4 metal = " + texel +
         ";\n  float rough = max(other.x * metal.g, 0.04);\n"
         "  if (other.w == 1.0) gloss.a = clamp(roundEven(2.0 / ((rough * rough) * (rough * rough)) - 2.0), 1.0, "
         "8192.0);\n  glow.a = glow.a * metal.b;\n";
}

std::string geometry_fragment_text(const Pipeline& pipeline, const GlslOptions& options) {
  std::string text = glsl_header(options.version, "geometry pass: stores the surface, one plane an attachment");
  text += varyings_text(pipeline, options, "in");
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  for (size_t i = 0; i < planes.size(); ++i)
    text += "layout(location = " + std::to_string(i) + ") out " +
            (planes[i].format == Format::r32ui ? "uint " : "vec4 ") + planes[i].output + ";\n";
  text += reads_materials(pipeline.light_model) ? "uniform samplerBuffer materials;\n" : "";
  text += "\nvoid main() {\n" + material_text(pipeline.light_model, options);
  for (const GlslPlane& plane : planes) {
    text += "  " + plane.output + " = ";
    if (plane.name == "position") text += "vec4(world_position, 1.0);\n";
    if (plane.name == "normal")
      text += "vec4(" + normal_text(pipeline, options) + (halves_normals(pipeline) ? " * 0.5 + 0.5" : "") + ", 1.0);\n";
    if (plane.name == "albedo") text += "albedo;\n";
    if (plane.name == "specular") text += "gloss;\n";
    if (plane.name == "emission")  // another format may stand in for one without alpha
      text += info(pipeline.gbuffer.emission).channels < 4 ? "vec4(emission.rgb, 1.0);\n" : "emission;\n";
    if (plane.name == "uv") text += "vec4(texcoord, 0.0, 1.0);\n";
    if (plane.name == "id.object") text += "ids.x;\n";
    if (plane.name == "id.material") text += "ids.y;\n";
    if (plane.name == "id.primitive") text += "uint(gl_PrimitiveID) + 1u;\n";
  }
  return text + "}\n";
}

constexpr const char* kUnitNormal = R"(
vec3 unit_normal(vec3 n) {
  float n2 = (n.x * n.x + n.y * n.y) + n.z * n.z;
  return n * (n2 > 0.0 ? 1.0 / sqrt(n2) : 0.0);
}
)";

/// docs/arithmetic.md section 13: a texel of a normal map in the frame of the triangle's texture coordinates, or of
/// vertices' tangents.
std::string bent_normal_text(const GlslOptions& options) {
  return R"(uniform sampler2D normal_map;
uniform float normal_scale;

// The normal of a texel: x along growing u, y along growing v, both across N; N where u and v do not grow.
vec3 bent_normal(vec3 N, vec3 texel) {
  float n2 = dot(N, N);
  vec3 U = )" +
         std::string(options.vertex_tangents ? "tangent_side == 0.0 ? along_u : vertex_tangent" : "along_u") +
         R"(;
  vec3 T = U - N * (dot(N, U) / n2);
  float t2 = dot(T, T);
  if (!(n2 > 0.0 && t2 > 0.0)) return N;
  T = T * inversesqrt(t2);
  vec3 C = cross(N, T);
  float v = )" +
         (options.vertex_tangents ? "tangent_side == 0.0 ? dot(C, along_v) : tangent_side" : "dot(C, along_v)") +
         R"(;
  vec3 B = C * (v < 0.0 ? -inversesqrt(n2) : inversesqrt(n2));
  vec3 t = vec3((2.0 * texel.xy - 1.0) * normal_scale, 2.0 * texel.z - 1.0);
  return (T * t.x + B * t.y) + N * t.z;
}
)";
}

/// What a vertex shader makes of the frame of its triangle, and of its own tangent.
std::string tangents_text(const GlslOptions& options) {
  if (!options.normal_maps) return {};
  const auto turned = [](const std::string& v) {
    return "vec3(linear(world_from_object[0].xyz, " + v + "), linear(world_from_object[1].xyz, " + v +
           "), linear(world_from_object[2].xyz, " + v + "));\n";
  };
  std::string text = "  int frame = gl_VertexID / 3 * " +
                     std::string(options.more_uv ? "12 + 2 * normal_uv_set" : "2") +
                     ";\n"
                     "  vec3 u = texelFetch(tangents, frame).xyz, v = texelFetch(tangents, frame + 1).xyz;\n"
                     "  along_u = " +
                     turned("u") + "  along_v = " + turned("v");
  if (!options.vertex_tangents) return text;
  return text + "  vec4 own = texelFetch(vertex_tangents, gl_VertexID);\n  vertex_tangent = " + turned("own.xyz") +
         "  vec3 rows = cross(world_from_object[0].xyz, world_from_object[1].xyz);\n"
         "  tangent_side = dot(rows, world_from_object[2].xyz) < 0.0 ? -own.w : own.w;  // of a matrix that mirrors\n";
}

/// `vec3 P` from its plane, or from the stored depth as docs/arithmetic.md section 7 says.
std::string position_text(const GBufferState& g) {
  if (!g.position_from_depth) return "  vec3 P = texelFetch(position_plane, pixel, 0).xyz;\n";
  return R"(  float depth = texelFetch(depth_plane, pixel, 0).x;
  vec3 ndc = vec3((gl_FragCoord.xy - ndc_from_window.xy) * ndc_from_window.zw - ndc_origin,
                  (depth - depth_to_ndc.x) * depth_to_ndc.y);
  vec4 h = ((world_from_clip[0] * ndc.x + world_from_clip[1] * ndc.y) + world_from_clip[2] * ndc.z) + world_from_clip[3];
  vec3 P = h.xyz * (1.0 / h.w);
)";
}

}  // namespace

std::string glsl_header(int version, std::string_view purpose) {
  return "#version " + std::to_string(version) + " core\n// Trueshade, " + std::string(purpose) + ".\n";
}

std::string glsl_float(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", double(value));
  std::string literal = text;
  if (literal.find_first_of(".e") == std::string::npos) literal += ".0";
  return literal;
}

std::vector<GlslPlane> planes_of(const Pipeline& pipeline, const GlslOptions& options) {
  const GBufferState& g = pipeline.gbuffer;
  std::vector<GlslPlane> planes;
  const auto add = [&](const char* name, const char* word, Format format) {
    planes.push_back(
        {name, std::string("out_") + word, std::string(word) + "_plane", renderable(format, options.rgb16f)});
  };
  if (!g.position_from_depth) add("position", "position", g.position.format);
  add("normal", "normal", g.normal.format);
  add("albedo", "albedo", g.albedo.format);
  const ProgramReads reads = surface_reads(pipeline, options);
  if (options.uv || reads.uv) add("uv", "uv", g.uv.format);
  if (reads_specular_plane(pipeline.light_model)) add("specular", "specular", g.specular);
  if (pipeline.light_model.emission) add("emission", "emission", g.emission);
  const bool w = info(planes[0].format).channels == 4;
  if (options.ids || !w || reads.object) add("id.object", "object", Format::r32ui);
  if (options.ids || reads.material) add("id.material", "material", Format::r32ui);
  if (options.ids && options.primitive && planes.size() < kMostPlanes) add("id.primitive", "primitive", Format::r32ui);
  return planes;
}

const GlslPlane& coverage_plane(const std::vector<GlslPlane>& planes) {
  if (info(planes[0].format).channels == 4) return planes[0];  // position or normal, whose w is 1
  for (const GlslPlane& plane : planes)
    if (plane.name == "id.object") return plane;
  assert(false);  // planes_of() adds it where the first plane has no w
  return planes[0];
}

std::string varyings_text(const Pipeline& pipeline, const GlslOptions& options, const std::string& direction) {
  const GBufferState& g = pipeline.gbuffer;
  std::string text;
  const auto declare = [&](Interpolation interpolation, const char* type, const char* name) {
    text += qualifier(interpolation) + ' ' + direction + ' ' + type + ' ' + name + ";\n";
  };
  if (!g.position_from_depth) declare(g.position.interpolation, "vec3", "world_position");
  declare(g.normal.interpolation, "vec3", "world_normal");
  if (options.vertex_color) declare(g.albedo.interpolation, "vec4", "color");
  if (!options.instance_uniforms) declare(Interpolation::flat, "vec4", "base");
  if (options.instance_uniforms && direction == "in") text += "uniform vec4 base;\n";
  if (carries_uv(pipeline, options)) declare(g.uv.interpolation, "vec2", "texcoord");
  for (const std::string& map : maps_with_own_uv(options))
    declare(g.uv.interpolation, "vec2", (map + "_texcoord").c_str());
  if (options.normal_maps) declare(Interpolation::flat, "vec3", "along_u");
  if (options.normal_maps) declare(Interpolation::flat, "vec3", "along_v");
  if (options.vertex_tangents) declare(g.normal.interpolation, "vec3", "vertex_tangent");
  if (options.vertex_tangents) declare(Interpolation::flat, "float", "tangent_side");
  if (carries_ids(pipeline, options)) declare(Interpolation::flat, "uvec2", "ids");
  if (options.maps && direction == "in") text += "uniform sampler2D color_map;\nuniform float alpha_cutoff;\n";
  if (options.double_sided && direction == "in") text += "uniform bool double_sided;\n";
  if (direction == "in")
    for (const std::string& name : material_maps(pipeline.light_model, options))
      text += "uniform sampler2D " + name + "_map;\n";
  if (direction == "in" && made_unit_at_fragment(g.unit_normals)) text += kUnitNormal;
  if (options.normal_maps && direction == "in") text += bent_normal_text(options);
  return text;
}

std::string surface_uniforms_text(const Pipeline& pipeline, const GlslOptions& options) {
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  std::string text;
  const ProgramReads reads = surface_reads(pipeline, options);
  const GlslPlane& coverage = coverage_plane(planes);
  for (const GlslPlane& plane : planes) {
    const bool id = plane.format == Format::r32ui;
    const bool read = plane.name == "uv"            ? reads.uv
                      : plane.name == "id.material" ? reads.material
                      : id                          ? plane == coverage || (plane.name == "id.object" && reads.object)
                                                    : true;
    if (read) text += std::string("uniform ") + (id ? "usampler2D " : "sampler2D ") + plane.sampler + ";\n";
  }
  if (pipeline.gbuffer.position_from_depth)
    text +=
        "uniform sampler2D depth_plane;\nuniform mat4 world_from_clip;\nuniform vec4 ndc_from_window;\n"
        "uniform vec2 ndc_origin;\nuniform vec2 depth_to_ndc;\n";
  return text;
}

std::string read_surface_text(const Pipeline& pipeline, const GlslOptions& options) {
  const GlslPlane coverage = coverage_plane(planes_of(pipeline, options));
  const bool ids = coverage.format == Format::r32ui;
  return "  ivec2 pixel = ivec2(gl_FragCoord.xy);\n  if (texelFetch(" + coverage.sampler +
         (ids ? ", pixel, 0).x == 0u" : ", pixel, 0).w == 0.0") + ") discard;\n" + position_text(pipeline.gbuffer) +
         "  vec3 stored_normal = texelFetch(normal_plane, pixel, 0).xyz" +
         (halves_normals(pipeline) ? " * 2.0 - 1.0" : "") +
         ";\n"
         "  vec4 albedo = texelFetch(albedo_plane, pixel, 0);\n" +
         (reads_specular_plane(pipeline.light_model) ? "  vec4 gloss = texelFetch(specular_plane, pixel, 0);\n" : "") +
         (pipeline.light_model.emission ? "  vec4 emission = texelFetch(emission_plane, pixel, 0);\n" : "");
}

bool reads_materials(const LightModel& model) {
  return reads_specular_plane(model) || maps_metals(model) || model.emission;
}

std::string material_text(const LightModel& model, const GlslOptions& options) {
  std::string text = "  vec4 albedo = " + albedo_text(options) + ";\n";
  if (options.maps) text += "  if (albedo.a < alpha_cutoff) discard;\n";
  if (!reads_materials(model)) return text;
  const std::string first = std::to_string(kMaterialTexels) + " * int(ids.y) - ";
  for (const auto& [name, at] : {std::pair("gloss", 3), std::pair("glow", 2), std::pair("other", 1)})
    text += std::string("  vec4 ") + name + " = texelFetch(materials, " + first + std::to_string(at) + ");\n";
  text += "  vec4 emission = vec4(glow.rgb, 1.0);  // a: the share of ambient light that arrives\n";
  const std::string color = shows_unlit(model) && options.unlit ? "  vec3 own_color = albedo.rgb;\n" : "";
  text += color;
  if (model.keeps_metals) text += "  gloss = vec4(glow.a, other.x, 0.0, 0.0);  // metallic, roughness\n";
  for (const std::string& name : material_maps(model, options)) text += map_text(name, model, options);
  if (maps_metals(model) && !model.keeps_metals)
    text +=
        "  gloss.rgb = vec3(0.04) * (1.0 - glow.a) + albedo.rgb * glow.a;\n"
        "  albedo.rgb = albedo.rgb * (1.0 - glow.a);\n";
  if (!color.empty())
    text +=
        "  if (other.z == 1.0) {\n    emission = vec4(own_color, 1.0);\n    albedo.rgb = gloss.rgb = vec3(0.0);\n  }\n";
  return text;
}

std::string albedo_text(const GlslOptions& options) {
  return std::string(options.vertex_color ? "color * " : "") +
         (options.maps ? lookup_text("color", options) + " * " : "") + "base";
}

std::string normal_text(const Pipeline& pipeline, const GlslOptions& options) {
  std::string normal = "world_normal";
  if (made_unit_at_fragment(pipeline.gbuffer.unit_normals)) normal = "unit_normal(" + normal + ")";
  if (options.normal_maps) normal = "bent_normal(" + normal + ", " + lookup_text("normal", options) + ".xyz)";
  return options.double_sided ? normal + " * (double_sided && !gl_FrontFacing ? -1.0 : 1.0)" : normal;
}

std::string vertex_text(const Pipeline& pipeline, const GlslOptions& options) {
  std::string text = glsl_header(options.version, "geometry pass: matrices are rows, rounded once from double");
  text += R"(layout(location = 0) in vec3 object_position;
layout(location = 1) in vec3 object_normal;
layout(location = 2) in vec4 vertex_color;  // 1 where the mesh has none
layout(location = 3) in vec2 vertex_uv;
)";
  text += options.instance_uniforms ? R"(uniform vec4 clip_from_object[4];
uniform vec4 world_from_object[3];
uniform vec3 normal_from_object[3];  // inverse transpose
uniform uvec2 instance_ids;
)"
                                    : R"(layout(location = 4) in vec4 clip_from_object[4];
layout(location = 8) in vec4 world_from_object[3];
layout(location = 11) in vec3 normal_from_object[3];  // inverse transpose
layout(location = 14) in vec4 base_color;
layout(location = 15) in uvec2 instance_ids;
)";
  if (options.normal_maps)
    text += "uniform samplerBuffer tangents;  // two texels a triangle" +
            std::string(options.more_uv ? " and each of six sets" : "") +
            ", in the object: where u grows, where v grows\n";
  if (options.vertex_tangents)
    text += "uniform samplerBuffer vertex_tangents;  // a texel a vertex: its tangent and w; 0 where it has none\n";
  text += more_uv_text(options);
  text += varyings_text(pipeline, options, "out");
  if (options.version >= 400) text += "precise gl_Position;\n";
  text += R"(
float affine(vec4 row, vec3 p) { return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w; }
float linear(vec3 row, vec3 v) { return (row.x * v.x + row.y * v.y) + row.z * v.z; }
)";
  if (made_unit_at_vertex(pipeline.gbuffer.unit_normals)) text += kUnitNormal;
  text += R"(
void main() {
  vec3 p = object_position;
  gl_Position = vec4(affine(clip_from_object[0], p), affine(clip_from_object[1], p), affine(clip_from_object[2], p),
                     affine(clip_from_object[3], p));
  vec3 n = vec3(linear(normal_from_object[0], object_normal), linear(normal_from_object[1], object_normal),
                linear(normal_from_object[2], object_normal));
)";
  text += made_unit_at_vertex(pipeline.gbuffer.unit_normals) ? "  world_normal = unit_normal(n);\n"
                                                             : "  world_normal = n;\n";
  if (options.vertex_color) text += "  color = vertex_color;\n";
  if (!options.instance_uniforms) text += "  base = base_color;\n";
  if (!pipeline.gbuffer.position_from_depth)
    text +=
        "  world_position = vec3(affine(world_from_object[0], p), affine(world_from_object[1], p), "
        "affine(world_from_object[2], p));\n";
  if (carries_uv(pipeline, options)) text += "  texcoord = vertex_uv;\n";
  for (const std::string& map : maps_with_own_uv(options))
    text += "  " + map + "_texcoord = uv_of(" + map + "_uv_set);\n";
  text += tangents_text(options);
  if (carries_ids(pipeline, options)) text += "  ids = instance_ids;\n";
  return text + "}\n";
}

std::string fullscreen_vertex_text(int version) {
  return glsl_header(version, "one triangle over the whole image, drawn with 3 vertices and no buffer") + R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
}

Pipeline drawn_pipeline(const Pipeline& pipeline) {
  const std::shared_ptr<const LightText> program = light_text_of(pipeline);
  Pipeline p = program == nullptr ? pipeline : with_planes_of(pipeline, program->reads);
  p.gbuffer = surface_planes(pipeline);
  return p;
}

GlslShaders shaders_of(const Pipeline& pipeline, const GlslOptions& options) {
  const Pipeline drawn = drawn_pipeline(pipeline);
  GlslShaders shaders{vertex_text(drawn, options), geometry_fragment_text(drawn, options), {}, {}, {}};
  set_light_shaders(drawn, options, shaders);
  if (!options.transparent || pipeline.transparency.mode != TransparencyMode::after_lights) return shaders;
  Pipeline forward = pipeline;
  forward.strategy = Strategy::forward_loop;
  forward.light_model.alpha_from_albedo = true;
  forward = drawn_pipeline(forward);
  shaders.transparent_vert = vertex_text(forward, options);
  GlslShaders lit{{}, {}, {}, {}, {}};
  set_light_shaders(forward, options, lit);
  shaders.transparent_frag = lit.light_frag;
  return shaders;
}

}  // namespace trueshade::oracle
