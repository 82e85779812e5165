// Light passes as GLSL: around the text of a light program, which is the pipeline's or its light model's. Ours comes
// before that text, so that no macro of a user's changes it, and calls the program by functions that stand behind it.
#include <algorithm>
#include <string>
#include <string_view>

#include "gl/emit/light_record.h"
#include "gl/emit/light_text.h"
#include "scenes/light_models/stated_model.h"

namespace trueshade::oracle {
namespace {

/// Where the user's text begins: what is behind the last line is string 1 to compilers.
constexpr std::string_view kUserText =
    "\nlayout(std140) uniform;  // so that a block which says nothing has these offsets\n#line 1 1\n";

constexpr const char* kBuffer = R"(uniform samplerBuffer lights;  // a record a light
uniform int light_count;
layout(location = 0) out vec4 target;

)";

/// A member of View: the uniform that it is made of, and what it is where the program does not read it.
struct ViewMember {
  std::string_view name, uniform, value, unread;
};
constexpr ViewMember kViewMembers[] = {
    {"eye", "vec3 eye", "eye", "vec3(0.0)"},
    {"axis", "vec3 view_axis", "-view_axis", "vec3(0.0)"},
    {"view", "vec4 view_from_world[4]", "ts_matrix_of(view_from_world)", "mat4(0.0)"},
    {"projection", "vec4 clip_from_view[4]", "ts_matrix_of(clip_from_view)", "mat4(0.0)"},
    {"view_projection", "vec4 view_projection[4]", "ts_matrix_of(view_projection)", "mat4(0.0)"},
    {"size", "vec4 picture_place", "picture_place.zw", "vec2(0.0)"},
    {"time", "vec3 moment", "moment.x", "0.0"},
    {"frame", "vec3 moment", "uint(moment.y) * 65536u + uint(moment.z)", "0u"},
};

/// The light program of a pass.
struct PassProgram {
  std::string text;
  programs::LightOutline outline;
  ProgramReads reads;

  bool reads_input(std::string_view name) const {  // "view.eye"; of a matrix some element
    return std::any_of(outline.inputs.begin(), outline.inputs.end(), [name](const std::string& input) {
      return input.starts_with(name) &&
             (input.size() == name.size() || input[name.size()] == '.' || input[name.size()] == '[');
    });
  }
  bool reads_pixel() const { return reads_input("surface.pixel_x") || reads_input("surface.pixel_y"); }
};

PassProgram pass_program(const Pipeline& p, const GlslOptions& options) {
  if (p.light_program.used()) return {p.light_program.text, light_text_of(p)->outline, surface_reads(p, options)};
  const LightModel& model = p.light_model;
  PassProgram out;
  out.text = program_of(model, "light_model", options.products ? Spelling::in_products : Spelling::for_drivers).text;
  const auto has = [&out](std::string_view words) { return out.text.find(words) != std::string::npos; };
  out.outline.defines_start = has("\nvec3 start(");
  out.outline.defines_finish = has("\nvec4 finish(");
  const auto reads = [&out](const std::string& member) {
    for (size_t at = 0; (at = out.text.find(member, at)) != std::string::npos;)
      if (const char next = out.text[at += member.size()]; next != '_' && (next < 'a' || next > 'z')) return true;
    return false;
  };
  for (const ViewMember& m : kViewMembers)
    if (reads("v." + std::string(m.name))) out.outline.inputs.push_back("view." + std::string(m.name));
  for (const LightMember& m : kLightMembers)
    if (reads("l." + std::string(m.name))) out.outline.inputs.push_back("light." + std::string(m.name));
  out.reads.gloss = reads_specular_plane(model);
  out.reads.emission = model.emission;
  return out;
}

/// The uniforms that the program reads, each once, and of these `View ts_view()`.
std::string view_uniforms_text(const PassProgram& program) {
  std::string text;
  const auto add = [&text](std::string_view uniform) {
    const std::string line = "uniform " + std::string(uniform) + ";\n";
    if (text.find(line) == std::string::npos) text += line;
  };
  for (const ViewMember& m : kViewMembers)
    if (program.reads_input("view." + std::string(m.name))) add(m.uniform);
  if (program.reads_pixel()) add("vec4 picture_place");
  return text;
}

std::string view_text(const PassProgram& program) {
  std::string text = "\nView ts_view() {\n  View v;\n";
  for (const ViewMember& m : kViewMembers)
    text += "  v." + std::string(m.name) + " = " +
            std::string(program.reads_input("view." + std::string(m.name)) ? m.value : m.unread) + ";\n";
  text += "  return v;\n}\n";
  if (text.find("ts_matrix_of") == std::string::npos) return text;
  return "\nmat4 ts_matrix_of(vec4 rows[4]) { return transpose(mat4(rows[0], rows[1], rows[2], rows[3])); }\n" + text;
}

std::vector<size_t> texels_of(const PassProgram& program) {
  std::vector<size_t> out{0, 1};  // the extent and unlit surfaces ask for them too
  for (size_t i = 2; i < kLightTexels; ++i)
    if (std::any_of(std::begin(kLightMembers), std::end(kLightMembers), [&](const LightMember& m) {
          return m.texel == i && program.reads_input("light." + std::string(m.name));
        }))
      out.push_back(i);
  return out;
}

/// The GLSL expression of a member of Light, of the texel that holds it: "t0.xyz".
std::string value_of(const LightMember& m) {
  const std::string value = "t" + std::to_string(m.texel) + '.' + std::string(m.components);
  return m.made_by.empty() ? value : std::string(m.made_by) + '(' + value + ')';
}
std::string unread_of(const LightMember& m) {
  if (m.name == "type") return "light_type_point";
  return m.made_by == "uint" ? "0u" : m.components.size() == 3 ? "vec3(0.0)" : "0.0";
}

/// `Light ts_light_of(int i)`.
std::string light_of_text(const PassProgram& program) {
  const std::vector<size_t> texels = texels_of(program);
  std::string text = "\nLight ts_light_of(int i) {\n";
  for (size_t k = 0; k < texels.size(); ++k)
    text += "  vec4 t" + std::to_string(texels[k]) + " = texelFetch(lights, " + std::to_string(texels.size()) +
            " * i + " + std::to_string(k) + ");\n";
  text += "  Light l;\n";
  for (const LightMember& m : kLightMembers) {
    const bool there = std::find(texels.begin(), texels.end(), m.texel) != texels.end();
    text += "  l." + std::string(m.name) + " = " + (there ? value_of(m) : unread_of(m)) + ";\n";
  }
  return text + "  l.shadow = l.cookie = -1;\n" +
         "  for (int k = 0; k < 4; ++k) l.user[k] = vec4(0.0);\n  return l;\n}\n";
}

/// The name of light_interface.glsl for a type.
std::string type_constant(LightType type) { return "light_type_" + std::string(name_of(type)); }

/// The type of a light whose record says `type`. Types that no light of the scene has are left out, so that compilers
/// leave out what a program does with them.
std::string type_text(const GlslOptions& options) {
  std::string text = "uint ts_type_of(float type) {\n";
  for (size_t i = 0; i < std::size(kLightTypes); ++i)
    if (LightType(i) != LightType::point && (options.light_types >> i & 1) != 0)
      text += "  if (type == " + std::to_string(i) + ".0) return " + type_constant(LightType(i)) + ";\n";
  return text + "  return light_type_point;\n}\n";
}

/// Functions behind the user's text, declared: those of them that main calls.
std::string declared_text(const programs::LightOutline& has) {
  const bool order = !has.variables.empty() && (has.defines_start || has.defines_finish);
  return std::string("\n// Behind the light program's text.\nvec3 ts_added(Surface s, Light l, View v);\n") +
         (order && has.defines_reaches ? "bool ts_reaches(Surface s, Light l, View v);\n" : "") +
         (has.defines_start ? "vec3 ts_start(Surface s, View v);\n" : "") +
         (has.defines_finish ? "vec4 ts_finish(Surface s, View v, vec3 sum);\n" : "") +
         (has.variables.empty()
              ? ""
              : "void ts_keep();   // what the file's variables start as\nvoid ts_fresh();  // makes them so\n");
}

std::string tail_text(const programs::LightOutline& has) {
  std::string text =
      "#line 1 2\nvec3 ts_added(Surface ts_s, Light ts_l, View ts_v) { return light(ts_s, ts_l, ts_v); }\n";
  if (has.defines_reaches)
    text += "bool ts_reaches(Surface ts_s, Light ts_l, View ts_v) { return reaches(ts_s, ts_l, ts_v); }\n";
  if (has.defines_start) text += "vec3 ts_start(Surface ts_s, View ts_v) { return start(ts_s, ts_v); }\n";
  if (has.defines_finish)
    text += "vec4 ts_finish(Surface ts_s, View ts_v, vec3 ts_sum) { return finish(ts_s, ts_v, ts_sum); }\n";
  if (has.variables.empty()) return text;
  std::string keep, fresh;
  for (size_t i = 0; i < has.variables.size(); ++i) {
    const programs::FileVariable& v = has.variables[i];
    const std::string kept = "ts_kept_" + std::to_string(i);
    if (v.zero.empty()) text += v.type + ' ' + kept + ";\n";
    if (v.zero.empty()) keep += "  " + kept + " = " + v.name + ";\n";
    fresh += "  " + v.name + " = " + (v.zero.empty() ? kept : v.zero) + ";\n";
  }
  return text + "void ts_keep() {\n" + keep + "}\nvoid ts_fresh() {\n" + fresh + "}\n";
}

/// `Surface s` of `vec3 P, stored_normal` and `vec4 albedo, gloss, emission`.
std::string surface_fields_text(const Pipeline& p, const PassProgram& program) {
  const ProgramReads& reads = program.reads;
  const bool forward = is_forward(p.strategy);
  const auto id = [&](bool read, const char* plane, const char* varying) {
    return !read     ? std::string("0u")
           : forward ? std::string(varying)
                     : "texelFetch(" + std::string(plane) + ", pixel, 0).x";
  };
  const auto field = [](const char* name, const std::string& value) {
    return "  s." + std::string(name) + " = " + value + ";\n";
  };
  return "  Surface s;\n" + field("position", "P") + field("normal", "stored_normal") + field("albedo", "albedo") +
         field("specular", reads.gloss ? "gloss.rgb" : "vec3(0.0)") +
         field("shininess", reads.gloss ? "gloss.a" : "0.0") + field("metallic", reads.metals ? "gloss.r" : "0.0") +
         field("roughness", reads.metals ? "gloss.g" : "0.0") +
         field("occlusion", reads.emission ? "emission.a" : "1.0") +
         field("emission", reads.emission ? "emission.rgb" : "vec3(0.0)") +
         field("uv", !reads.uv ? "vec2(0.0)"
                     : forward ? "texcoord"
                               : "texelFetch(uv_plane, pixel, 0).xy") +
         field("uv1", "vec2(0.0)") + field("tangent", "vec4(0.0)") +
         field("object", id(reads.object, "object_plane", "ids.x")) +
         field("material", id(reads.material, "material_plane", "ids.y")) +
         field("pixel_x", program.reads_pixel() ? "uint(gl_FragCoord.x - picture_place.x)" : "0u") +
         field("pixel_y", program.reads_pixel() ? "uint(gl_FragCoord.y - picture_place.y)" : "0u") +
         "  for (int k = 0; k < 4; ++k) s.user[k] = vec4(0.0);\n";
}

/// Surfaces whose material is unlit are done: the first draw gives them their albedo, and lights leave them out.
std::string unlit_text(const LightDraw& draw) {
  using Kind = LightDraw::Kind;
  const std::string leaves = draw.kind == Kind::pass    ? "    if (" + draw.light + " > 0) discard;\n"
                             : draw.kind == Kind::light ? "    discard;\n"
                                                        : "";
  return "  if (texelFetch(materials, 3 * int(s.material) - 1).z == 1.0) {\n" + leaves +
         "    target = albedo;\n    return;\n  }\n";
}
static_assert(kMaterialTexels == 3);

/// True where the extent of the light `l` does not have the pixel; empty where no extent ends.
std::string beyond_text_of(const Pipeline& p, const GlslOptions& options) {
  const RangeLimits limits = limits_range(p);
  if (!limits.any()) return {};
  std::string bounded;
  for (size_t i = 0; i < std::size(kLightTypes); ++i)
    if (limits.ends(LightType(i)) && (LightType(i) == LightType::point || (options.light_types >> i & 1) != 0))
      bounded += (bounded.empty() ? "l.type == " : " || l.type == ") + type_constant(LightType(i));
  return bounded.empty() ? bounded : "(" + bounded + ") && !(distance(l.position, P) < l.range)";
}

/// The file's variables as the functions before start() leave them, whatever the light.
std::string order_text(const programs::LightOutline& has) {
  if (has.variables.empty()) return {};
  return std::string("  ts_fresh();\n  ts_added(s, ts_light_of(0), v);\n") +
         (has.defines_reaches ? "  ts_reaches(s, ts_light_of(0), v);\n" : "");
}

/// Adds all lights.
std::string loop_text(const Pipeline& p, const GlslOptions& options, const programs::LightOutline& has,
                      const LightDraw& draw) {
  const std::string beyond = beyond_text_of(p, options);
  return "  for (int i = " + draw.first + "; i < " + draw.end + "; ++i) {\n    Light l = ts_light_of(i);\n" +
         (beyond.empty() ? "" : "    if (" + beyond + ") continue;\n") +
         (has.variables.empty() ? "" : "    ts_fresh();\n") + "    sum += ts_added(s, l, v);\n  }\n";
}

/// Statements of a draw that has one light: its term becomes `sum`. In a pass over the scene the term of light 0 is
/// added to what `sum` starts from.
std::string one_light_text(const Pipeline& p, const GlslOptions& options, const programs::LightOutline& has,
                           const LightDraw& draw) {
  const bool pass = draw.kind == LightDraw::Kind::pass;
  const std::string fresh = has.variables.empty() ? "" : "  ts_fresh();\n", beyond = beyond_text_of(p, options);
  const std::string light = "  Light l = ts_light_of(max(" + draw.light + ", 0));\n";
  const std::string is_beyond = beyond.empty() ? "" : "  bool beyond = " + beyond + ";\n";
  if (!pass)
    return light + (beyond.empty() ? "" : "  if (" + beyond + ") discard;\n") + fresh + "  sum = ts_added(s, l, v);\n";
  return light + is_beyond + (beyond.empty() ? "" : "  if (beyond && " + draw.light + " > 0) discard;\n") + fresh +
         "  vec3 added = ts_added(s, l, v);\n  if (" + draw.light + " > 0)\n    sum = added;\n  else if (" +
         draw.light + " == 0" + (beyond.empty() ? "" : " && !beyond") + " && added != vec3(0.0))\n    sum += added;\n";
}

std::string sum_text_of(const Pipeline& p, const GlslOptions& options, const programs::LightOutline& has,
                        const LightDraw& draw) {
  using Kind = LightDraw::Kind;
  const bool kept = !has.variables.empty(), starts = has.defines_start && draw.kind != Kind::light;
  std::string text = "  View v = ts_view();\n";
  if (kept) text += "  ts_keep();\n";
  text += starts ? order_text(has) + "  vec3 sum = ts_start(s, v);\n" : "  vec3 sum = vec3(0.0);\n";
  if (draw.kind == Kind::sum) text += loop_text(p, options, has, draw);
  if (draw.kind == Kind::pass || draw.kind == Kind::light) text += one_light_text(p, options, has, draw);
  if (!has.defines_finish)
    return text + "  target = vec4(sum, " + (p.light_model.alpha_from_albedo ? "albedo.a" : "1.0") + ");\n";
  return text + order_text(has) + (kept && has.defines_start ? "  ts_start(s, v);\n" : "") +
         "  target = ts_finish(s, v, sum);\n";
}

}  // namespace

std::string light_fragment_text(const Pipeline& p, const GlslOptions& options, const LightDraw& draw) {
  const PassProgram program = pass_program(p, options);
  const programs::LightOutline& has = program.outline;
  const bool forward = is_forward(p.strategy), unlit = options.unlit && p.light_program.used();
  std::string text = glsl_header(options.version, draw.what);
  text += forward ? varyings_text(p, options, "in") : surface_uniforms_text(p, options);
  if (unlit || (forward && reads_materials(p.light_model))) text += "uniform samplerBuffer materials;\n";
  text += draw.declared + view_uniforms_text(program) + kBuffer + std::string(programs::light_interface()) +
          type_text(options) + light_of_text(program) + view_text(program) + declared_text(has) + "\nvoid main() {\n";
  text += forward ? "  vec3 P = world_position;\n  vec3 stored_normal = " + normal_text(p, options) + ";\n" +
                        material_text(p.light_model, options)
                  : read_surface_text(p, options);
  text += surface_fields_text(p, program) + (unlit ? unlit_text(draw) : "") + draw.before +
          sum_text_of(p, options, has, draw) + "}\n";
  const std::string& file = program.text;
  return text + std::string(kUserText) + file + (file.ends_with('\n') ? "" : "\n") + tail_text(has);
}

std::vector<size_t> light_texels(const Pipeline& pipeline) { return texels_of(pass_program(pipeline, {})); }

std::string_view own_text(std::string_view shader) { return shader.substr(0, shader.find(kUserText)); }

}  // namespace trueshade::oracle
