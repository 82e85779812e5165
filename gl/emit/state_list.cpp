#include "gl/emit/state_list.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "gl/emit/draw_plan.h"
#include "gl/emit/light_record.h"
#include "gl/emit/light_text.h"
#include "gl/emit/post_glsl.h"
#include "gl/emit/shader_interface.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

std::string attachments(const std::vector<GlslPlane>& planes, ShaderApi api) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < planes.size(); ++i)
    lines.push_back(std::string("{\"attachment\": \"") + (api == ShaderApi::vulkan ? "color " : "GL_COLOR_ATTACHMENT") +
                    std::to_string(i) + "\", \"plane\": " + quoted(planes[i].name) + ", \"format\": " +
                    quoted(format_name(api, planes[i].format)) + ", \"output\": " + quoted(planes[i].output) +
                    ", \"sampler\": " + quoted(planes[i].sampler) + ", \"clear\": 0}");
  return array_of(lines);
}

/// What the draws of instances do with faces that the geometry state does not say.
std::string geometry_draws(const GlslOptions& options) {
  std::string text = "instances in order, a draw of indexed triangles for each run of one mesh";
  if (options.double_sided)
    text +=
        "; where the material is double-sided, back faces are not culled, and of both front faces alone; where the "
        "instance is mirrored (glTF: a negative determinant), the other winding is the front";
  return quoted(text);
}

struct Meaning {
  const char *name, *meaning;
};

constexpr Meaning kMeanings[] = {
    {"object_position", "of the mesh"},
    {"object_normal", "of the mesh"},
    {"vertex_color", "1 where the mesh has none"},
    {"vertex_uv", "0 where the mesh has none"},
    {"clip_from_object", "rows of projection * view * world_from_object in double, rounded to float once"},
    {"world_from_object", "rows"},
    {"normal_from_object", "rows of the inverse transpose of world_from_object's linear part"},
    {"base_color", "of the material, linear"},
    {"instance_ids", "object + 1 and material + 1"},
    {"corner", "of a light's mesh, in the world, or of a quad, in normalized device coordinates"},
    {"color_map", "a white texel where the material has none"},
    {"specular_map", "a white texel where the material has none"},
    {"metallic_roughness_map", "a white texel where the material has none"},
    {"emission_map", "a white texel where the material has none"},
    {"occlusion_map", "a white texel where the material has none"},
    {"normal_map", "a texel 0.5, 0.5, 1 where the material has none"},
    {"normal_scale", "of the material"},
    {"alpha_cutoff", "of the material, 0 where it has none"},
    {"double_sided", "whether the material is"},
    {"color_uv_set", "the set that the material's map reads, 0 is vertex_uv"},
    {"specular_uv_set", "the same of this map"},
    {"normal_uv_set", "the same of this map"},
    {"metallic_roughness_uv_set", "the same of this map"},
    {"emission_uv_set", "the same of this map"},
    {"occlusion_uv_set", "the same of this map"},
    {"tangents",
     "RGBA32F texels, two a triangle of the mesh (with more_uv, two for each of six sets), unit vectors in the object "
     "along growing u and growing v, 0 where uv has no area; no two triangles share a vertex: gl_VertexID / 3 is the "
     "triangle"},
    {"vertex_tangents",
     "RGBA32F texels, one a vertex: of meshes with tangents the tangent in the object and 1 or -1, the same at a "
     "triangle's corners: the normal map's green points along it times normal x tangent; else 0"},
    {"more_uv", "RGBA32F texels, five a vertex, u and v of sets 1 to 5, 0 where the mesh has none"},
    {"materials",
     "RGBA32F texels, three a material: specular colour, shininess (with metallic and rough materials that of the "
     "roughness); emission, metallic; roughness, strength of the occlusion map, 1 where the material is unlit, 1 where "
     "it has a metallic_roughness_map"},
    {"lights", "RGBA32F texels, light_layout says what a light is"},
    {"light_count", "how many lights there are"},
    {kDrawnLight, "the draw's, counted from 0"},
    {"mesh", "1: corners are in the world, 0: a quad over the image"},
    {"eye", "the camera's position in the world"},
    {"view_axis", "the view's z axis in the world, towards the viewer, of unit length"},
    {"clip_from_world", "rows of projection * view in double, rounded to float once"},
    {"view_projection", "rows of projection * view, as in clip_from_world"},
    {"view_from_world", "rows of the view's matrix, 0 where the camera is one matrix"},
    {"clip_from_view", "rows of the projection's matrix, 0 where the camera is one matrix"},
    {"moment", "seconds; the number of the frame, divided by 65536, and the rest"},
    {"depth_plane", "the depth attachment, its value in x"},
    {"world_from_clip", "inverse of projection * view in double, rounded to float once"},
    {"ndc_from_window",
     "viewport x, y, 2 / width, 2 / height (clip origin upper left: -2 / height); y grows upwards from the lowest row"},
    {"ndc_origin", "1, 1 (clip origin upper left: 1, -1)"},
    {"depth_to_ndc", "t, 1 / s of window z = s * ndc z + t"},
    {"picture_place", "the picture in the window: x, y, width, height in pixels"},
    {"picture", "see post_passes"},
    {"blurred", "see post_passes"},
    {"logarithms", "see post_passes"},
};

std::string meaning_of(const std::string& name) {
  for (const Meaning& m : kMeanings)
    if (name == m.name) return m.meaning;
  assert(name.ends_with("_plane"));
  return "the geometry attachment of that sampler";
}

std::string variable_text(const ShaderVariable& v) {
  const std::string elements = v.elements > 0 ? "[" + std::to_string(v.elements) + "]" : "";
  return v.name + ": " + v.type + elements + ", " + meaning_of(v.name);
}

/// What the vertex shaders of the scene read of each vertex and each instance.
std::string attributes(const std::string& vertex) {
  std::vector<std::string> lines;
  for (const ShaderVariable& v : interface_of(vertex).inputs)
    lines.push_back(std::to_string(v.location) +
                    (v.elements > 0 ? " to " + std::to_string(v.location + v.elements - 1) : "") + " " +
                    variable_text(v) + (v.location >= kFirstInstanceLocation ? "; divisor 1" : ""));
  return strings_of(lines);
}

/// The uniforms of all shaders, each once.
std::string uniforms(const ShaderTexts& shaders) {
  std::vector<std::string> lines;
  for (const auto& [name, text] : shaders)
    for (const ShaderVariable& v : interface_of(text).uniforms)
      if (const std::string line = variable_text(v); std::find(lines.begin(), lines.end(), line) == lines.end())
        lines.push_back(line);
  return strings_of(lines);
}

std::string light_layout(const Pipeline& pipeline) {
  std::vector<std::string> texels;
  for (const size_t i : light_texels(pipeline)) texels.push_back(words_of_texel(i));
  return strings_of(texels);
}

/// Scalars of the light program's block of parameters.
std::string parameters(const Pipeline& pipeline) {
  const programs::LightOutline outline = light_text_of(pipeline)->outline;
  std::vector<std::string> lines;
  for (const programs::ParameterPlace& place : outline.parameters)
    if (const std::optional<float> value = parameter_value(place.name, pipeline.light_program))
      lines.push_back(outline.parameter_block + ", byte " + std::to_string(place.offset) + ": " +
                      place.name.substr(place.name.find('.') + 1) + " = " + glsl_float(*value));
  return strings_of(lines);
}

/// The state of a draw.
std::string state_text(ShaderApi api, const DrawState& state, const std::vector<Format>& attachments) {
  if (api == ShaderApi::vulkan) return vulkan_state(state, attachments);
  return strings_of(gl_calls(api, state, int(attachments.size())));
}

/// What a draw is of: a word, and what it means.
std::string geometry_text(const PlannedDraw& draw) {
  switch (draw.geometry) {
    case DrawnGeometry::scene:
      return draw.lights == DrawnLights::others
                 ? "scene: once more a light, the depth kept"
                 : "scene: again, with a depth buffer of its own, cleared as the geometry pass's";
    case DrawnGeometry::glass:
      return draw.lights == DrawnLights::none
                 ? "scene: transparent surfaces, into the geometry attachments"
                 : "scene: transparent surfaces, into the light target, with the depth of the opaque ones";
    case DrawnGeometry::quad:
    case DrawnGeometry::quads:
      return "quad: 4 corners of normalized device coordinates, a strip of triangles, uniform mesh 0";
    case DrawnGeometry::meshes:
      return "mesh: triangles in the world, counter-clockwise from outside, uniform mesh 1";
    case DrawnGeometry::triangle:
      break;
  }
  return "triangle: 3 vertices, no vertex buffer";
}

std::string extents_text(const LightVolumes& v) {
  const std::string extents[] = {"quads", "quads", "meshes: boxes of half side range",
                                 "meshes: spheres of radius range", "meshes: cones, apex at the light, base at range"};
  return "points as " + extents[size_t(v.point)] + "; spots as " + extents[size_t(v.spot)];
}

/// Of which lights.
std::string drawn_lights_text(const PlannedDraw& draw, const LightVolumes& volumes) {
  switch (draw.lights) {
    case DrawnLights::none:
      return draw.geometry == DrawnGeometry::glass ? "none: not in the geometry pass, but after it, before the lights"
                                                   : "none: once, before the lights";
    case DrawnLights::all:
      return draw.geometry == DrawnGeometry::glass ? "all: in no pass before, but after the lights" : "all";
    case DrawnLights::first:
      return "first: light 0 (uniform light; -1 in a scene without lights)";
    case DrawnLights::others:
      return "others: a draw a light (uniform light) in light order";
    case DrawnLights::each:
      break;
  }
  return draw.geometry == DrawnGeometry::meshes
             ? "meshes: in the same order; " + extents_text(volumes)
             : "quads: a draw a light (uniform light) in light order; ambient, directional and unbounded ones; " +
                   extents_text(volumes);
}

std::string draw_entry(const PlannedDraw& draw, const Pipeline& pipeline, ShaderApi api,
                       const std::vector<Format>& attachments) {
  return "{\"shaders\": [" + quoted(draw.vert) + ", " + quoted(draw.frag) +
         "], \"geometry\": " + quoted(geometry_text(draw)) +
         ", \"of\": " + quoted(drawn_lights_text(draw, pipeline.light_volumes)) +
         ",\n     \"state\": " + state_text(api, draw.state, attachments) + "}";
}

/// The passes of the post chain, in order.
std::string post_list(const Pipeline& pipeline, int version, ShaderApi api) {
  std::vector<std::string> lines;
  for (const PostPass& pass : post_passes(pipeline, version)) {
    std::string reads;
    for (const auto& [sampler, picture] : pass.reads)
      reads += (reads.empty() ? "" : ", ") + quoted(sampler) + ": " + quoted(picture);
    lines.push_back("{\"shaders\": [\"post.vert\", \"post_" + pass.name + ".frag\"], \"reads\": {" + reads +
                    "}, \"writes\": " + quoted(pass.writes) + ", \"size\": [" + std::to_string(pass.width) + ", " +
                    std::to_string(pass.height) + "], \"format\": " + quoted(format_name(api, pass.format)) + "}");
    if (pass.name == "load" && pipeline.post.marker_radius > 0.0f)
      lines.push_back(
          "{\"shaders\": [\"markers.vert\", \"markers.frag\"], \"writes\": \"loaded\", \"depth\": \"the frame's\", "
          "\"draws\": \"a sphere a light, the geometry pass's state, back faces culled\"}");
  }
  return array_of(lines);
}

}  // namespace

ShaderTexts gl_shader_files(const Pipeline& pipeline, const GlslOptions& options) {
  const GlslShaders shaders = shaders_of(pipeline, options);
  ShaderTexts files = {{"geometry.vert", shaders.geometry_vert},
                       {"geometry.frag", shaders.geometry_frag},
                       {"light.vert", shaders.light_vert},
                       {"light.frag", shaders.light_frag},
                       {"base.frag", shaders.base_frag},
                       {"transparent.vert", shaders.transparent_vert},
                       {"transparent.frag", shaders.transparent_frag}};
  for (const PostPass& pass : post_passes(pipeline, options.version)) {
    const std::string name = "post_" + pass.name + ".frag";
    if (std::none_of(files.begin(), files.end(), [&](const auto& file) { return file.first == name; }))
      files.emplace_back(name, pass.frag);
  }
  if (pipeline.post.active()) files.emplace_back("post.vert", fullscreen_vertex_text(options.version));
  if (pipeline.post.marker_radius > 0.0f) {
    files.emplace_back("markers.vert", marker_vertex_text(pipeline, options.version));
    files.emplace_back("markers.frag", marker_fragment_text(pipeline, options.version));
  }
  std::erase_if(files, [](const auto& file) { return file.second.empty(); });
  return files;
}

ShaderTexts shader_files(const Pipeline& pipeline, const GlslOptions& options, ShaderApi api) {
  ShaderTexts files = gl_shader_files(pipeline, options);
  for (auto& [name, text] : files)
    text = in_terms_of(api, name.ends_with(".vert") ? ShaderStage::vertex : ShaderStage::fragment, text);
  return files;
}

std::string state_list(const Pipeline& asked, const GlslOptions& options, ShaderApi api) {
  const Pipeline pipeline = drawn_pipeline(asked);
  const std::vector<GlslPlane> planes = planes_of(pipeline, options);
  std::vector<Format> attached;
  for (const GlslPlane& plane : planes) attached.push_back(plane.format);
  const Format target = renderable(pipeline.target, options.rgb16f);
  const ShaderTexts shaders = gl_shader_files(asked, options);
  std::string pipeline_text = pipeline_json(pipeline);
  while (!pipeline_text.empty() && pipeline_text.back() == '\n') pipeline_text.pop_back();
  const auto entry = [](const char* key, const std::string& value) {
    return "  " + quoted(key) + ": " + value + ",\n";
  };
  std::vector<std::string> lights, glass;
  for (const PlannedDraw& draw : light_draws(pipeline, options))
    lights.push_back(draw_entry(draw, pipeline, api, {target}));
  if (const std::optional<PlannedDraw> draw = glass_draw(pipeline, options); draw && options.transparent)
    glass.push_back(
        draw_entry(*draw, pipeline, api, draw->lights == DrawnLights::none ? attached : std::vector<Format>{target}));
  return entry("api", quoted(std::string(kShaderApiNames[size_t(api)]))) + entry("pipeline", pipeline_text) +
         entry("geometry_shaders", "[\"geometry.vert\", \"geometry.frag\"]") +
         entry("geometry_attachments", attachments(planes, api)) +
         entry("geometry_depth", "{\"format\": " + quoted(format_name(api, pipeline.geometry.depth_format)) +
                                     ", \"clear\": " + glsl_float(pipeline.geometry.clear_depth) + "}") +
         entry("geometry_state", state_text(api, geometry_draw(pipeline).state, attached)) +
         entry("geometry_attributes", attributes(shaders.front().second)) +
         entry("geometry_draws", geometry_draws(options)) +
         entry("light_target", "{\"format\": " + quoted(format_name(api, target)) +
                                   ", \"clear\": \"the scene's clear colour" +
                                   (alpha_stands_in(pipeline, options) ? ", its alpha 1" : "") + "\"}") +
         entry("light_draws", array_of(lights)) +
         (options.transparent ? entry("transparent_draws", array_of(glass)) : "") +
         entry("post_passes", post_list(asked, options.version, api)) + entry("uniforms", uniforms(shaders)) +
         (pipeline.light_program.used() ? entry("parameters", parameters(pipeline)) : "") +
         "  \"light_layout\": " + light_layout(pipeline);
}

}  // namespace trueshade::oracle
