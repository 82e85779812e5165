#include "tests/programs/oracle/compiled_light.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <spirv-tools/libspirv.h>

#include <memory>
#include <stdexcept>

namespace trueshade::testing {

namespace {

constexpr const char* kDeclarations = R"(#version 460
layout(local_size_x = 1) in;
struct Surface {
  vec3 position;
  vec3 normal;
  vec4 albedo;
  vec3 specular;
  float shininess;
  float metallic, roughness, occlusion;
  vec3 emission;
  vec2 uv, uv1;
  vec4 tangent;
  uint object, material, pixel_x, pixel_y;
  vec4 user[4];
};
struct Light {
  uint type, index;
  vec3 position;
  float range;
  vec3 direction;
  vec3 color;
  vec3 attenuation;
  vec3 ambient;
  float cone, penumbra, cos_inner, cos_outer, cone_scale, cone_offset, spot_exponent;
  float penumbra_slope, cutoff_slope;
  vec3 right, up;
  int shadow, cookie;
  vec4 user[4];
};
const uint light_type_ambient = 0u, light_type_directional = 1u, light_type_point = 2u, light_type_spot = 3u;
struct View {
  vec3 eye, axis;
  mat4 view, projection, view_projection;
  vec2 size;
  float time;
  uint frame;
};
layout(std140, set = 0, binding = 0) uniform TsSurface { Surface ts_surface; };
layout(std140, set = 0, binding = 1) uniform TsLight { Light ts_light; };
layout(std140, set = 0, binding = 2) uniform TsView { View ts_view; };
layout(std140, set = 0, binding = 3) uniform TsSum { vec3 ts_sum; };
layout(std430, set = 0, binding = 4) buffer TsResult { vec3 light; uint reaches; vec3 start; vec4 finish; } ts_result;
)";

/// glslang for the length of the process.
struct Glslang {
  Glslang() { glslang_initialize_process(); }
  ~Glslang() { glslang_finalize_process(); }
  Glslang(const Glslang&) = delete;
  Glslang& operator=(const Glslang&) = delete;
};

template <auto kFree>
struct Freeing {
  template <typename T>
  void operator()(T* pointer) const {
    kFree(pointer);
  }
};

std::string numbered(const std::string& text) {
  std::string lines = "1: ";
  int line = 1;
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += std::to_string(++line) + ": ";
  }
  return lines;
}

std::runtime_error refused(const std::string& who, const std::string& log, const std::string& shader) {
  return std::runtime_error(who + ": " + log + "\n" + numbered(shader));
}

void validate(const std::vector<uint32_t>& words, const std::string& shader) {
  const std::unique_ptr<spv_context_t, Freeing<spvContextDestroy>> context(spvContextCreate(SPV_ENV_VULKAN_1_1));
  spv_const_binary_t binary{words.data(), words.size()};
  spv_diagnostic diagnostic = nullptr;
  const spv_result_t result = spvValidate(context.get(), &binary, &diagnostic);
  const std::string said = diagnostic != nullptr ? diagnostic->error : "";
  spvDiagnosticDestroy(diagnostic);
  if (result != SPV_SUCCESS) throw refused("spirv-val", said, shader);
}

}  // namespace

std::string whole_shader(const std::string& light_file, bool has_reaches, bool has_start, bool has_finish) {
  std::string text = kDeclarations;
  text += "#line 1\n" + light_file + "\nvoid main() {\n  vec3 made = light(ts_surface, ts_light, ts_view);\n";
  text += "  ts_result.light = made;\n  ts_result.reaches = uint(";
  text += has_reaches ? "reaches(ts_surface, ts_light, ts_view)" : "any(notEqual(made, vec3(0.0)))";
  text += ");\n  ts_result.start = ";
  text += has_start ? "start(ts_surface, ts_view)" : "vec3(0.0)";
  text += ";\n  ts_result.finish = ";
  text += has_finish ? "finish(ts_surface, ts_view, ts_sum)" : "vec4(ts_sum, 1.0)";
  return text + ";\n}\n";
}

std::vector<uint32_t> compiled_shader(const std::string& shader) {
  static const Glslang glslang;
  glslang_input_t input{};
  input.language = GLSLANG_SOURCE_GLSL, input.stage = GLSLANG_STAGE_COMPUTE;
  input.client = GLSLANG_CLIENT_VULKAN, input.client_version = GLSLANG_TARGET_VULKAN_1_1;
  input.target_language = GLSLANG_TARGET_SPV, input.target_language_version = GLSLANG_TARGET_SPV_1_3;
  input.code = shader.c_str();
  input.default_version = 460, input.default_profile = GLSLANG_NO_PROFILE;
  input.messages = GLSLANG_MSG_DEFAULT_BIT;
  input.resource = glslang_default_resource();
  const std::unique_ptr<glslang_shader_t, Freeing<glslang_shader_delete>> made(glslang_shader_create(&input));
  if (glslang_shader_preprocess(made.get(), &input) == 0 || glslang_shader_parse(made.get(), &input) == 0)
    throw refused("glslang", glslang_shader_get_info_log(made.get()), shader);
  const std::unique_ptr<glslang_program_t, Freeing<glslang_program_delete>> program(glslang_program_create());
  glslang_program_add_shader(program.get(), made.get());
  if (glslang_program_link(program.get(), GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT) == 0)
    throw refused("glslang", glslang_program_get_info_log(program.get()), shader);
  glslang_spv_options_t options{};
  options.disable_optimizer = true;
  glslang_program_SPIRV_generate_with_options(program.get(), input.stage, &options);
  std::vector<uint32_t> words(glslang_program_SPIRV_get_size(program.get()));
  glslang_program_SPIRV_get(program.get(), words.data());
  validate(words, shader);
  return words;
}

}  // namespace trueshade::testing
