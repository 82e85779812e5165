#include "gl/emit/state_list.h"

#include <utility>
#include <vector>

#include "gl/emit/post_glsl.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

std::string quoted(const std::string& text) { return '"' + text + '"'; }

std::string array_of(const std::vector<std::string>& lines) {
  std::string text = "[";
  for (const std::string& line : lines) text += (text.size() == 1 ? "\n    " : ",\n    ") + line;
  return text + (lines.empty() ? "]" : "\n  ]");
}

std::string calls(std::vector<std::string> lines) {
  for (std::string& line : lines) line = quoted(line);
  return array_of(lines);
}

std::string gl_name(Format format) {
  switch (format) {
    case Format::rgba8:
      return "GL_RGBA8";
    case Format::srgb8_a8:
      return "GL_SRGB8_ALPHA8";
    case Format::rgb10_a2:
      return "GL_RGB10_A2";
    case Format::rgba16:
      return "GL_RGBA16";
    case Format::r11g11b10f:
      return "GL_R11F_G11F_B10F";
    case Format::rgb16f:
      return "GL_RGB16F";
    case Format::rgba16f:
      return "GL_RGBA16F";
    case Format::rgba32f:
      return "GL_RGBA32F";
    case Format::rgb32f:
      return "GL_RGB32F";
    case Format::rg32f:
      return "GL_RG32F";
    case Format::r32ui:
      return "GL_R32UI";
    case Format::d32f:
      return "GL_DEPTH_COMPONENT32F";
    case Format::d24:
      return "GL_DEPTH_COMPONENT24";
    case Format::d16:
      return "GL_DEPTH_COMPONENT16";
  }
  return {};
}

std::string gl_name(DepthFunc func) {
  switch (func) {
    case DepthFunc::never:
      return "GL_NEVER";
    case DepthFunc::less:
      return "GL_LESS";
    case DepthFunc::equal:
      return "GL_EQUAL";
    case DepthFunc::lequal:
      return "GL_LEQUAL";
    case DepthFunc::greater:
      return "GL_GREATER";
    case DepthFunc::notequal:
      return "GL_NOTEQUAL";
    case DepthFunc::gequal:
      return "GL_GEQUAL";
    case DepthFunc::always:
      return "GL_ALWAYS";
  }
  return {};
}

std::string culling_call(CullFace face) {
  switch (face) {
    case CullFace::none:
      return "glDisable(GL_CULL_FACE)";
    case CullFace::front:
      return "glEnable(GL_CULL_FACE); glCullFace(GL_FRONT)";
    case CullFace::back:
      return "glEnable(GL_CULL_FACE); glCullFace(GL_BACK)";
    case CullFace::front_and_back:
      return "glEnable(GL_CULL_FACE); glCullFace(GL_FRONT_AND_BACK)";
  }
  return {};
}

std::string upper(std::string_view name) {
  std::string text;
  for (const char c : name) text += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return text;
}

std::string equation_name(BlendEquation equation) {
  const bool extreme = equation == BlendEquation::min || equation == BlendEquation::max;
  return (extreme ? "GL_" : "GL_FUNC_") + upper(kBlendEquationNames[size_t(equation)]);
}

std::string bool_name(bool on) { return on ? "GL_TRUE" : "GL_FALSE"; }

/// Blending and the colour mask.
std::vector<std::string> blend_calls(const BlendState& b) {
  std::string mask;
  for (size_t c = 0; c < 4; ++c) mask += (c == 0 ? "glColorMask(" : ", ") + bool_name(b.mask[c]);
  mask += ")";
  if (!b.enabled) return {"glDisable(GL_BLEND)", mask};
  const auto factor = [](BlendFactor f) { return "GL_" + upper(kBlendFactorNames[size_t(f)]); };
  std::string constant;
  for (size_t c = 0; c < 4; ++c) constant += (c == 0 ? "glBlendColor(" : ", ") + glsl_float(b.constant[c]);
  return {"glEnable(GL_BLEND)",
          "glBlendEquationSeparate(" + equation_name(b.rgb.equation) + ", " + equation_name(b.alpha.equation) + ")",
          "glBlendFuncSeparate(" + factor(b.rgb.src) + ", " + factor(b.rgb.dst) + ", " + factor(b.alpha.src) + ", " +
              factor(b.alpha.dst) + ")",
          constant + ")", mask};
}

/// What no pipeline asks for, and a context may have set.
std::vector<std::string> common_calls() {
  return {
      "glDisable(GL_DITHER)",         "glDisable(GL_MULTISAMPLE)",       "glDisable(GL_SCISSOR_TEST)",
      "glDisable(GL_STENCIL_TEST)",   "glDisable(GL_PRIMITIVE_RESTART)", "glPolygonMode(GL_FRONT_AND_BACK, GL_FILL)",
      "glEnable(GL_FRAMEBUFFER_SRGB)"};
}

void add(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

/// All but depth test and blending of a draw by that state.
std::vector<std::string> window_calls(const Pipeline& pipeline, const GeometryState& g) {
  Viewport v = g.viewport;
  if (v.width == 0 && v.height == 0) v = {v.x, v.y, pipeline.width, pipeline.height};
  const auto number = [](int value) { return std::to_string(value); };
  std::vector<std::string> lines = common_calls();
  add(lines, {"glViewport(" + number(v.x) + ", " + number(v.y) + ", " + number(v.width) + ", " + number(v.height) + ")",
              "glDepthRange(" + glsl_float(g.depth_near) + ", " + glsl_float(g.depth_far) + ")",
              std::string(g.depth_clamp ? "glEnable" : "glDisable") + "(GL_DEPTH_CLAMP)", culling_call(g.cull_face),
              std::string("glFrontFace(") + (g.front_face == FrontFace::ccw ? "GL_CCW)" : "GL_CW)"),
              std::string("glClipControl(") +
                  (g.clip_origin == ClipOrigin::upper_left ? "GL_UPPER_LEFT, " : "GL_LOWER_LEFT, ") +
                  (g.clip_depth == ClipDepth::zero_to_one ? "GL_ZERO_TO_ONE)" : "GL_NEGATIVE_ONE_TO_ONE)"),
              std::string(g.polygon_offset_factor != 0 || g.polygon_offset_units != 0 ? "glEnable" : "glDisable") +
                  "(GL_POLYGON_OFFSET_FILL); glPolygonOffset(" + glsl_float(g.polygon_offset_factor) + ", " +
                  glsl_float(g.polygon_offset_units) + ")",
              std::string("glProvokingVertex(") +
                  (g.provoking == Provoking::last ? "GL_LAST_VERTEX_CONVENTION)" : "GL_FIRST_VERTEX_CONVENTION)")});
  return lines;
}

std::string depth_calls(DepthFunc func, bool writes) {
  return "glEnable(GL_DEPTH_TEST); glDepthMask(" + bool_name(writes) + "); glDepthFunc(" + gl_name(func) + ")";
}

/// A draw of the scene.
std::vector<std::string> scene_calls(const Pipeline& pipeline, DepthFunc func, bool writes, const BlendState& blend) {
  std::vector<std::string> lines = window_calls(pipeline, pipeline.geometry);
  lines.push_back(depth_calls(func, writes));
  add(lines, blend_calls(blend));
  return lines;
}

std::vector<std::string> geometry_calls(const Pipeline& pipeline) {
  return scene_calls(pipeline, pipeline.geometry.depth_func, true, {});
}

std::string attachments(const std::vector<GlslPlane>& planes) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < planes.size(); ++i)
    lines.push_back("{\"attachment\": \"GL_COLOR_ATTACHMENT" + std::to_string(i) +
                    "\", \"plane\": " + quoted(planes[i].name) + ", \"format\": " + quoted(gl_name(planes[i].format)) +
                    ", \"output\": " + quoted(planes[i].output) + ", \"sampler\": " + quoted(planes[i].sampler) +
                    ", \"clear\": 0}");
  return array_of(lines);
}

std::string attributes() {
  return calls(
      {"0 object_position: vec3", "1 object_normal: vec3", "2 vertex_color: vec4, 1 where the mesh has none",
       "3 vertex_uv: vec2, 0 where the mesh has none",
       "4 to 7 clip_from_object: rows of projection * view * world_from_object in double, rounded to float once; "
       "divisor 1",
       "8 to 10 world_from_object: rows; divisor 1",
       "11 to 13 normal_from_object: rows of the inverse transpose of its linear part; divisor 1",
       "14 base_color: vec4; divisor 1", "15 instance_ids: uvec2, object + 1 and material + 1; divisor 1"});
}

/// Samplers of GlslOptions::maps, a draw a material.
std::string maps(const GlslOptions& options) {
  std::vector<std::string> lines;
  if (options.maps) lines = {"color_map: sampler2D, a white texel where the material has none", "alpha_cutoff: float"};
  if (options.specular_maps) lines.emplace_back("specular_map: sampler2D, a white texel where the material has none");
  if (options.metal_maps)
    lines.emplace_back(
        "metallic_roughness_map: sampler2D, a white texel where the material has none; in light models with metallic "
        "and rough materials");
  for (const auto& [there, name] :
       {std::pair(options.emission_maps, "emission_map"), std::pair(options.occlusion_maps, "occlusion_map")})
    if (there)
      lines.push_back(std::string(name) +
                      ": sampler2D, a white texel where the material has none; in light models with emission");
  if (options.normal_maps) {
    lines.emplace_back("normal_map: sampler2D, a texel 0.5, 0.5, 1 where the material has none; normal_scale: float");
    lines.emplace_back(
        "tangents: samplerBuffer over GL_RGBA32F, two texels a triangle of the mesh, unit vectors in the object along "
        "growing u and growing v, 0 where uv has no area; no two triangles share a vertex: gl_VertexID / 3 is the "
        "triangle");
  }
  if (options.more_uv) {
    lines.back() += options.normal_maps ? "; six such pairs a triangle, one a set of texture coordinates" : "";
    lines.emplace_back(
        "more_uv: samplerBuffer over GL_RGBA32F, five texels a vertex, u and v of sets 1 to 5, 0 where the mesh has "
        "none; color_uv_set, specular_uv_set, normal_uv_set: int, the set that a map reads, 0 is vertex_uv");
  }
  if (options.double_sided) lines.emplace_back("double_sided: bool, of the material");
  return calls(lines);
}

/// What the draws of instances do with faces that the geometry state does not say.
std::string geometry_draws(const GlslOptions& options) {
  std::string text = "instances in order, glDrawElementsInstanced(GL_TRIANGLES)";
  if (options.double_sided)
    text +=
        "; where the material is double-sided, GL_BACK is not culled, and of GL_FRONT_AND_BACK GL_FRONT alone; where "
        "the instance is mirrored (glTF: a negative determinant), the other glFrontFace";
  return quoted(text);
}

std::string uniforms(const Pipeline& pipeline) {
  std::vector<std::string> lines{"lights: samplerBuffer over GL_RGBA32F, light_layout says what a light is",
                                 "light_count: int", "eye: vec3, the camera's position in the world"};
  if (reads_materials(pipeline.light_model))
    lines.push_back(
        "materials: samplerBuffer over GL_RGBA32F, in shaders that draw surfaces; three texels a material: specular "
        "colour, shininess (with metallic and rough materials that of the roughness); emission, metallic; roughness, "
        "strength of the occlusion map, 1 where the material is unlit, 1 where it has a metallic_roughness_map");
  if (pipeline.gbuffer.position_from_depth) {
    lines.push_back("depth_plane: sampler2D, the depth attachment");
    lines.push_back("world_from_clip: mat4, inverse of projection * view in double, rounded to float once");
    lines.push_back("ndc_from_window: vec4, viewport x, y, 2 / width, 2 / height (GL_UPPER_LEFT: -2 / height)");
    lines.push_back("ndc_origin: vec2, 1, 1 (GL_UPPER_LEFT: 1, -1)");
    lines.push_back("depth_to_ndc: vec2, t, 1 / s of window z = s * ndc z + t");
  }
  return calls(lines);
}

std::string light_layout(const LightModel& model) {
  std::vector<std::string> texels{
      "x, y, z: position (directional: minus the direction it travels); "
      "w: 0 ambient, 1 directional, 2 point, 2.5 spot without a cone, 3 spot",
      "r, g, b: linear colour times intensity; a: range"};
  const LightLayout layout(model);
  if (layout.attenuation) texels.push_back("k0, k1, k2, 0: attenuation");
  if (layout.cone) texels.push_back("x, y, z, 0: the way the light travels");
  if (layout.cone)
    texels.push_back(model.cone == Cone::exponent ? "cosine of the cutoff, exponent, 0, 0"
                     : model.cone == Cone::squared_penumbra
                         ? "scale, offset of the cosine, 0, 0"
                         : "cosines where the light is 0 and where it is full, 0, 0");
  if (layout.ambient) texels.push_back("r, g, b, 0: its ambient share");
  return calls(texels);
}

constexpr const char* kNoDepth = "glDisable(GL_DEPTH_TEST); glDepthMask(GL_FALSE)";

/// One kind of draw into the light target: its shaders, what is drawn, of which lights, and all of its state.
std::string draw_entry(const char* vertex, const char* fragment, const std::string& geometry, const std::string& of,
                       const std::vector<std::string>& state) {
  std::string text = std::string("{\"shaders\": [\"") + vertex + "\", \"" + fragment +
                     "\"], \"geometry\": " + quoted(geometry) + ", \"of\": " + quoted(of) + ",\n     \"state\": [";
  for (size_t i = 0; i < state.size(); ++i) text += (i == 0 ? "\n      " : ",\n      ") + quoted(state[i]);
  return text + "]}";
}

/// Light geometry over the image: no depth test, nothing of the scene's culling.
std::vector<std::string> volume_calls(const Pipeline& pipeline, CullFace culled, const BlendState& blend) {
  GeometryState g = pipeline.geometry;
  g.cull_face = culled;
  g.front_face = FrontFace::ccw;
  g.depth_clamp = pipeline.light_volumes.depth_clamp;
  std::vector<std::string> lines = window_calls(pipeline, g);
  lines.emplace_back(kNoDepth);
  add(lines, blend_calls(blend));
  return lines;
}

std::vector<std::string> volume_draws(const Pipeline& pipeline) {
  const LightVolumes& v = pipeline.light_volumes;
  const std::string quad = "quad: 4 corners of normalized device coordinates, GL_TRIANGLE_STRIP, uniform mesh 0";
  std::vector<std::string> draws;
  if (v.base)
    draws.push_back(draw_entry("light.vert", "base.frag", quad, "none: once, before the lights",
                               volume_calls(pipeline, CullFace::none, {})));
  const std::string extents[] = {"quads", "quads", "meshes: boxes of half side range",
                                 "meshes: spheres of radius range", "meshes: cones, apex at the light, base at range"};
  const std::string point = extents[size_t(v.point)], spot = extents[size_t(v.spot)];
  draws.push_back(draw_entry("light.vert", "light.frag", quad,
                             "quads: a draw a light (uniform light) in light order; ambient, directional and unbounded "
                             "ones; points as " +
                                 point + "; spots as " + spot,
                             volume_calls(pipeline, CullFace::none, pipeline.blend)));
  if (is_mesh(v.point) || is_mesh(v.spot))
    draws.push_back(draw_entry("light.vert", "light.frag",
                               "mesh: triangles in the world, counter-clockwise from outside, uniform mesh 1",
                               "meshes: in the same order; points as " + point + "; spots as " + spot,
                               volume_calls(pipeline, v.cull_face, pipeline.blend)));
  return draws;
}

std::vector<std::string> image_calls(const Pipeline& pipeline) {
  Pipeline image = pipeline;
  image.geometry = {};
  std::vector<std::string> lines = window_calls(image, image.geometry);
  lines.emplace_back(kNoDepth);
  add(lines, blend_calls({}));
  return lines;
}

std::vector<std::string> light_draws(const Pipeline& pipeline) {
  const std::string again = "scene: again, with a depth buffer of its own, cleared as the geometry pass's";
  const DepthFunc func = pipeline.geometry.depth_func;
  switch (pipeline.strategy) {
    case Strategy::forward_multipass:
      return {
          draw_entry("light.vert", "light.frag", again, "first: light 0 (uniform light; -1 in a scene without lights)",
                     scene_calls(pipeline, func, true, {})),
          draw_entry("light.vert", "light.frag", "scene: once more a light, the depth kept",
                     "others: a draw a light (uniform light) in light order",
                     scene_calls(pipeline, DepthFunc::equal, false, kAddLight))};
    case Strategy::forward_loop:
      return {draw_entry("light.vert", "light.frag", again, "all", scene_calls(pipeline, func, true, {}))};
    case Strategy::deferred_volumes:
      return volume_draws(pipeline);
    case Strategy::deferred_loop:
      break;
  }
  return {draw_entry("light.vert", "light.frag", "triangle: glDrawArrays(GL_TRIANGLES, 0, 3), no vertex buffer", "all",
                     image_calls(pipeline))};
}

/// The draw of transparent surfaces; none where they are drawn with the others, as if they were opaque.
std::vector<std::string> transparent_draws(const Pipeline& pipeline, const std::vector<GlslPlane>& planes) {
  const DepthFunc func = pipeline.geometry.depth_func;
  std::vector<std::string> state = scene_calls(pipeline, func, false, pipeline.transparency.blend);
  switch (pipeline.transparency.mode) {
    case TransparencyMode::none:
      return {};
    case TransparencyMode::into_albedo:
      for (size_t i = 0; i < planes.size(); ++i) {
        const std::string at = std::to_string(i);
        if (planes[i].name != "albedo")
          state.push_back("glDisablei(GL_BLEND, " + at + "); glColorMaski(" + at +
                          ", GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE)");
      }
      return {draw_entry("geometry.vert", "geometry.frag", "scene: transparent surfaces, into the geometry attachments",
                         "none: not in the geometry pass, but after it, before the lights", state)};
    case TransparencyMode::after_lights:
      break;
  }
  return {draw_entry("transparent.vert", "transparent.frag",
                     "scene: transparent surfaces, into the light target, with the depth of the opaque ones",
                     "all: in no pass before, but after the lights", state)};
}

/// The passes of the post chain, in order.
std::string post_list(const Pipeline& pipeline, int version) {
  std::vector<std::string> lines;
  for (const PostPass& pass : post_passes(pipeline, version)) {
    std::string reads;
    for (const auto& [sampler, picture] : pass.reads)
      reads += (reads.empty() ? "" : ", ") + quoted(sampler) + ": " + quoted(picture);
    lines.push_back("{\"shaders\": [\"post.vert\", \"post_" + pass.name + ".frag\"], \"reads\": {" + reads +
                    "}, \"writes\": " + quoted(pass.writes) + ", \"size\": [" + std::to_string(pass.width) + ", " +
                    std::to_string(pass.height) + "], \"format\": " + quoted(gl_name(pass.format)) + "}");
    if (pass.name == "load" && pipeline.post.marker_radius > 0.0f)
      lines.push_back(
          "{\"shaders\": [\"markers.vert\", \"markers.frag\"], \"writes\": \"loaded\", \"depth\": \"the frame's\", "
          "\"draws\": \"a sphere a light, the geometry pass's state, back faces culled\"}");
  }
  return array_of(lines);
}

}  // namespace

std::string state_list(const Pipeline& asked, const GlslOptions& options) {
  const Pipeline pipeline = drawn_pipeline(asked);
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  std::string pipeline_text = pipeline_json(pipeline);
  while (!pipeline_text.empty() && pipeline_text.back() == '\n') pipeline_text.pop_back();
  const auto entry = [](const char* key, const std::string& value) {
    return "  " + quoted(key) + ": " + value + ",\n";
  };
  return "{\n" + entry("pipeline", pipeline_text) +
         entry("geometry_shaders", "[\"geometry.vert\", \"geometry.frag\"]") +
         entry("geometry_attachments", attachments(planes)) +
         entry("geometry_depth", "{\"format\": " + quoted(gl_name(pipeline.geometry.depth_format)) +
                                     ", \"clear\": " + glsl_float(pipeline.geometry.clear_depth) + "}") +
         entry("geometry_state", calls(geometry_calls(pipeline))) + entry("geometry_attributes", attributes()) +
         entry("geometry_maps", maps(options)) + entry("geometry_draws", geometry_draws(options)) +
         entry("light_target",
               "{\"format\": " + quoted(gl_name(pipeline.target)) + ", \"clear\": \"the scene's clear colour\"}") +
         entry("light_draws", array_of(light_draws(pipeline))) +
         (options.transparent ? entry("transparent_draws", array_of(transparent_draws(pipeline, planes))) : "") +
         entry("post_passes", post_list(asked, options.version)) + entry("light_uniforms", uniforms(pipeline)) +
         "  \"light_layout\": " + light_layout(pipeline.light_model) + "\n}\n";
}

}  // namespace trueshade::oracle
