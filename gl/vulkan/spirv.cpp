#include "gl/vulkan/spirv.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

#include <memory>
#include <stdexcept>

namespace trueshade::oracle {

namespace {

/// glslang for the length of the process.
struct Compiler {
  Compiler() { glslang_initialize_process(); }
  ~Compiler() { glslang_finalize_process(); }
  Compiler(const Compiler&) = delete;
  Compiler& operator=(const Compiler&) = delete;
};

/// Frees what glslang made.
template <auto kFree>
struct Freed {
  template <typename T>
  void operator()(T* pointer) const {
    kFree(pointer);
  }
};

std::runtime_error wrong(const std::string& name, const char* log) {
  return std::runtime_error("GLSL of " + name + ": " + log);
}

}  // namespace

std::vector<uint32_t> spirv_of(const std::string& name, ShaderStage stage, const std::string& text) {
  static const Compiler compiler;
  glslang_input_t input{};
  input.language = GLSLANG_SOURCE_GLSL;
  input.stage = stage == ShaderStage::vertex ? GLSLANG_STAGE_VERTEX : GLSLANG_STAGE_FRAGMENT;
  input.client = GLSLANG_CLIENT_VULKAN, input.client_version = GLSLANG_TARGET_VULKAN_1_3;
  input.target_language = GLSLANG_TARGET_SPV, input.target_language_version = GLSLANG_TARGET_SPV_1_6;
  input.code = text.c_str();
  input.default_version = 450, input.default_profile = GLSLANG_NO_PROFILE;
  input.messages = GLSLANG_MSG_DEFAULT_BIT;
  input.resource = glslang_default_resource();
  const std::unique_ptr<glslang_shader_t, Freed<glslang_shader_delete>> shader(glslang_shader_create(&input));
  if (glslang_shader_preprocess(shader.get(), &input) == 0 || glslang_shader_parse(shader.get(), &input) == 0)
    throw wrong(name, glslang_shader_get_info_log(shader.get()));
  const std::unique_ptr<glslang_program_t, Freed<glslang_program_delete>> program(glslang_program_create());
  glslang_program_add_shader(program.get(), shader.get());
  if (glslang_program_link(program.get(), GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT) == 0)
    throw wrong(name, glslang_program_get_info_log(program.get()));
  glslang_program_SPIRV_generate(program.get(), input.stage);
  std::vector<uint32_t> words(glslang_program_SPIRV_get_size(program.get()));
  glslang_program_SPIRV_get(program.get(), words.data());
  return words;
}

}  // namespace trueshade::oracle
