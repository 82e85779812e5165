#include "gl/emit/draw_state.h"

#include "core/error.h"
#include "gl/emit/format_words.h"
#include "gl/emit/glsl.h"

namespace trueshade::oracle {

namespace {

constexpr const char* kCompareNames[] = {"NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"};
constexpr const char* kVulkanCompareNames[] = {
    "NEVER", "LESS", "EQUAL", "LESS_OR_EQUAL", "GREATER", "NOT_EQUAL", "GREATER_OR_EQUAL", "ALWAYS"};

constexpr const char* kCullNames[] = {"NONE", "FRONT_BIT", "BACK_BIT", "FRONT_AND_BACK"};

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
std::vector<std::string> common_calls(ShaderApi api) {
  if (api == ShaderApi::es31)
    return {"glDisable(GL_DITHER)", "glDisable(GL_SCISSOR_TEST)", "glDisable(GL_STENCIL_TEST)",
            "glDisable(GL_PRIMITIVE_RESTART_FIXED_INDEX)"};
  return {
      "glDisable(GL_DITHER)",         "glDisable(GL_MULTISAMPLE)",       "glDisable(GL_SCISSOR_TEST)",
      "glDisable(GL_STENCIL_TEST)",   "glDisable(GL_PRIMITIVE_RESTART)", "glPolygonMode(GL_FRONT_AND_BACK, GL_FILL)",
      "glEnable(GL_FRAMEBUFFER_SRGB)"};
}

void add(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

bool has_gl_clip_space(const GeometryState& g) {
  return g.clip_origin == ClipOrigin::lower_left && g.clip_depth == ClipDepth::negative_one_to_one;
}

std::string clip_control_call(ShaderApi api, const GeometryState& g) {
  return std::string(api == ShaderApi::es31 ? "glClipControlEXT(" : "glClipControl(") +
         (g.clip_origin == ClipOrigin::upper_left ? "GL_UPPER_LEFT, " : "GL_LOWER_LEFT, ") +
         (g.clip_depth == ClipDepth::zero_to_one ? "GL_ZERO_TO_ONE)" : "GL_NEGATIVE_ONE_TO_ONE)");
}

/// All but depth test and blending.
std::vector<std::string> window_calls(ShaderApi api, const DrawState& state) {
  const GeometryState& g = state.geometry;
  const Viewport& v = state.viewport;
  const auto number = [](int value) { return std::to_string(value); };
  std::vector<std::string> lines = common_calls(api);
  const bool es = api == ShaderApi::es31;
  add(lines, {"glViewport(" + number(v.x) + ", " + number(v.y) + ", " + number(v.width) + ", " + number(v.height) + ")",
              std::string(es ? "glDepthRangef(" : "glDepthRange(") + glsl_float(g.depth_near) + ", " +
                  glsl_float(g.depth_far) + ")"});
  if (!es || g.depth_clamp) lines.push_back(std::string(g.depth_clamp ? "glEnable" : "glDisable") + "(GL_DEPTH_CLAMP)");
  add(lines, {culling_call(g.cull_face),
              std::string("glFrontFace(") + (g.front_face == FrontFace::ccw ? "GL_CCW)" : "GL_CW)")});
  if (api == ShaderApi::gl || !has_gl_clip_space(g)) lines.push_back(clip_control_call(api, g));
  lines.push_back(std::string(g.polygon_offset_factor != 0 || g.polygon_offset_units != 0 ? "glEnable" : "glDisable") +
                  "(GL_POLYGON_OFFSET_FILL); glPolygonOffset(" + glsl_float(g.polygon_offset_factor) + ", " +
                  glsl_float(g.polygon_offset_units) + ")");
  if (es && g.provoking == Provoking::first)
    throw Error(ErrorKind::usage, "--api es31", "flat attributes of OpenGL ES follow the last vertex",
                "set provoking to last, or choose another API");
  if (!es)
    lines.push_back(std::string("glProvokingVertex(") +
                    (g.provoking == Provoking::last ? "GL_LAST_VERTEX_CONVENTION)" : "GL_FIRST_VERTEX_CONVENTION)"));
  return lines;
}

Viewport whole(const Pipeline& pipeline) {
  const Viewport v = pipeline.geometry.viewport;
  return v.width == 0 && v.height == 0 ? Viewport{v.x, v.y, pipeline.width, pipeline.height} : v;
}

const char* json_bool(bool on) { return on ? "true" : "false"; }

/// "VK_BLEND_OP_ADD" and the like.
std::string vulkan_name(const char* prefix, const std::string& name) {
  return quoted(std::string("VK_") + prefix + name);
}

std::string vulkan_term(const char* group, const BlendTerm& term) {
  const auto factor = [](BlendFactor f) { return vulkan_name("BLEND_FACTOR_", upper(kBlendFactorNames[size_t(f)])); };
  const std::string g = group;
  return "\"" + g + "BlendOp\": " + vulkan_name("BLEND_OP_", upper(kBlendEquationNames[size_t(term.equation)])) +
         ", \"src" + char(g[0] - 'a' + 'A') + g.substr(1) + "BlendFactor\": " + factor(term.src) + ", \"dst" +
         char(g[0] - 'a' + 'A') + g.substr(1) + "BlendFactor\": " + factor(term.dst);
}

std::string vulkan_blend(const BlendState& b) {
  std::string mask;
  constexpr const char* kBits[] = {"R", "G", "B", "A"};
  for (size_t c = 0; c < 4; ++c)
    if (b.mask[c]) mask += kBits[c];
  return std::string("{\"blendEnable\": ") + json_bool(b.enabled) + ", " + vulkan_term("color", b.rgb) + ", " +
         vulkan_term("alpha", b.alpha) + ", \"colorWriteMask\": " + quoted(mask) + "}";
}

}  // namespace

DrawState scene_state(const Pipeline& pipeline, DepthFunc func, bool writes, const BlendState& blend) {
  DrawState state{whole(pipeline), pipeline.geometry, true, writes, blend};
  state.geometry.depth_func = func;
  return state;
}

DrawState albedo_state(const Pipeline& pipeline, int albedo) {
  DrawState state = scene_state(pipeline, pipeline.geometry.depth_func, false, pipeline.transparency.blend);
  state.only = albedo;
  return state;
}

DrawState volume_state(const Pipeline& pipeline, CullFace culled, const BlendState& blend) {
  DrawState state{whole(pipeline), pipeline.geometry, false, false, blend};
  state.geometry.cull_face = culled;
  state.geometry.front_face = FrontFace::ccw;
  state.geometry.depth_clamp = pipeline.light_volumes.depth_clamp;
  return state;
}

DrawState image_state(int width, int height) { return {{0, 0, width, height}, {}, false, false, {}}; }

std::vector<std::string> gl_calls(ShaderApi api, const DrawState& state, int attachments) {
  std::vector<std::string> lines = window_calls(api, state);
  lines.push_back(state.depth_test ? "glEnable(GL_DEPTH_TEST); glDepthMask(" + bool_name(state.depth_write) +
                                         "); glDepthFunc(GL_" + kCompareNames[size_t(state.geometry.depth_func)] + ")"
                                   : "glDisable(GL_DEPTH_TEST); glDepthMask(GL_FALSE)");
  add(lines, blend_calls(state.blend));
  if (state.only < 0) return lines;
  if (api == ShaderApi::es31)
    throw Error(ErrorKind::usage, "--api es31", "a mask for each attachment, of into-albedo, is not in OpenGL ES 3.1",
                "choose another transparency or API");
  for (int i = 0; i < attachments; ++i)
    if (i != state.only)
      lines.push_back("glDisablei(GL_BLEND, " + std::to_string(i) + "); glColorMaski(" + std::to_string(i) +
                      ", GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE)");
  return lines;
}

std::string vulkan_state(const DrawState& state, const std::vector<Format>& attachments) {
  const GeometryState& g = state.geometry;
  const Viewport& v = state.viewport;
  const bool down = g.clip_origin == ClipOrigin::upper_left,
             offset = g.polygon_offset_factor != 0 || g.polygon_offset_units != 0;
  const std::string y = std::to_string(down ? v.y + v.height : v.y),
                    height = std::to_string(down ? -v.height : v.height);
  // Rows are OpenGL's, so that y grows as there, and Vulkan's areas have the other sign.
  const bool clockwise = (g.front_face == FrontFace::ccw) != down;
  std::string blends;
  for (int i = 0; i < int(attachments.size()); ++i) {
    BlendState blend = state.blend;
    if (info(attachments[size_t(i)]).number_class == NumberClass::integer) blend.enabled = false;
    if (state.only >= 0 && state.only != i) blend.enabled = false, blend.mask = {};
    blends += (i == 0 ? "" : ", ") + vulkan_blend(blend);
  }
  std::string constants;
  for (size_t c = 0; c < 4; ++c) constants += (c == 0 ? "" : ", ") + glsl_float(state.blend.constant[c]);
  const auto entry = [](const char* key, const std::string& value) {
    return "\n      \"" + std::string(key) + "\": " + value + ",";
  };
  return "{" +
         entry("viewport", "[" + std::to_string(v.x) + ", " + y + ", " + std::to_string(v.width) + ", " + height +
                               ", " + glsl_float(g.depth_near) + ", " + glsl_float(g.depth_far) + "]") +
         entry("negativeOneToOne", json_bool(g.clip_depth == ClipDepth::negative_one_to_one)) +
         entry("provokingVertexMode",
               vulkan_name("PROVOKING_VERTEX_MODE_",
                           g.provoking == Provoking::last ? "LAST_VERTEX_EXT" : "FIRST_VERTEX_EXT")) +
         entry("cullMode", vulkan_name("CULL_MODE_", kCullNames[size_t(g.cull_face)])) +
         entry("frontFace", vulkan_name("FRONT_FACE_", clockwise ? "CLOCKWISE" : "COUNTER_CLOCKWISE")) +
         entry("depthClampEnable", json_bool(g.depth_clamp)) + entry("depthBiasEnable", json_bool(offset)) +
         entry("depthBiasConstantFactor", glsl_float(g.polygon_offset_units)) +
         entry("depthBiasSlopeFactor", glsl_float(g.polygon_offset_factor)) +
         entry("depthTestEnable", json_bool(state.depth_test)) +
         entry("depthWriteEnable", json_bool(state.depth_test && state.depth_write)) +
         entry("depthCompareOp", vulkan_name("COMPARE_OP_", kVulkanCompareNames[size_t(g.depth_func)])) +
         entry("blendConstants", "[" + constants + "]") + "\n      \"attachments\": [" + blends + "]}";
}

std::string format_name(ShaderApi api, Format format) {
  return std::string(api == ShaderApi::vulkan ? words_of(format).vulkan : words_of(format).gl);
}

std::string quoted(const std::string& text) { return '"' + text + '"'; }

std::string array_of(const std::vector<std::string>& lines) {
  std::string text = "[";
  for (const std::string& line : lines) text += (text.size() == 1 ? "\n    " : ",\n    ") + line;
  return text + (lines.empty() ? "]" : "\n  ]");
}

std::string strings_of(std::vector<std::string> lines) {
  for (std::string& line : lines) line = quoted(line);
  return array_of(lines);
}

}  // namespace trueshade::oracle
