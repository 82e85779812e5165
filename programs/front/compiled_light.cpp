#include <map>
#include <utility>

#include "core/error.h"
#include "programs/front/driver_names.h"
#include "programs/front/glsl_compiler.h"
#include "programs/front/light_program.h"
#include "programs/front/spirv_module.h"

namespace trueshade::programs {
namespace {

/// Functions of our own with the signatures that the user's may have: their names in SPIR-V say how glslang spells
/// them.
constexpr const char* kSignatures = R"(
vec3 ts_light(Surface s, Light l, View v) { return vec3(0); }
bool ts_reaches(Surface s, Light l, View v) { return false; }
vec3 ts_start(Surface s, View v) { return vec3(0); }
vec4 ts_finish(Surface s, View v, vec3 sum) { return vec4(0); }
layout(local_size_x = 1) in;
void main() {}
)";

constexpr const char* kBlockDeclarations = R"(
layout(local_size_x = 1) in;
layout(std140, set = 0, binding = 0) uniform TsSurface { Surface ts_surface; };
layout(std140, set = 0, binding = 1) uniform TsLight { Light ts_light; };
layout(std140, set = 0, binding = 2) uniform TsView { View ts_view; };
layout(std140, set = 0, binding = 3) uniform TsSum { vec3 ts_sum; };
layout(std430, set = 0, binding = 4) buffer TsResult { vec3 light; uint reaches; vec3 start; vec4 finish; } ts_result;
)";

/// The functions that a text defines with the right signature and result, told by the compiler.
class Definitions {
 public:
  Definitions(const std::string& file, const std::string& text, const ProgramLimits& limits)
      : module_(spirv_module(words_of(file, text, limits))) {
    for (const auto& [id, function] : module_.functions) result_[module_.name(id)] = function.result_type;
  }

  bool has(const std::string& name) const {
    for (const auto& [spelling, result] : result_) {
      if (!spelling.starts_with("ts_" + name + "(")) continue;
      const auto users = result_.find(spelling.substr(3));
      return users != result_.end() && users->second == result;
    }
    return false;
  }

 private:
  /// Of a text that goes with a driver's names, so that what one command draws each other takes.
  static std::vector<uint32_t> words_of(const std::string& file, const std::string& text, const ProgramLimits& limits) {
    try {
      return spirv_of_glsl(file, text, kSignatures, true, kDriverNames, limits);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::limit) throw;
      spirv_of_glsl(file, text, kSignatures, true, {}, limits);  // what is wrong without them is said
      throw;
    }
  }

  SpirvModule module_;
  std::map<std::string, uint32_t> result_;  // by the name with the types of the parameters
};

std::string main_text(const CompiledLight& has) {
  std::string out = kBlockDeclarations;
  out += "void main() {\n  Surface ts_s = ts_surface; Light ts_l = ts_light; View ts_v = ts_view;\n";
  out += "  vec3 ts_added = light(ts_s, ts_l, ts_v);\n  ts_result.light = ts_added;\n";
  out += "  ts_s = ts_surface; ts_l = ts_light; ts_v = ts_view;\n";  // a parameter may be inout
  out += has.defines_reaches ? "  ts_result.reaches = reaches(ts_s, ts_l, ts_v) ? 1u : 0u;\n"
                             : "  ts_result.reaches = any(notEqual(ts_added, vec3(0))) ? 1u : 0u;\n";
  out += "  ts_s = ts_surface; ts_v = ts_view;\n";
  out += has.defines_start ? "  ts_result.start = start(ts_s, ts_v);\n" : "  ts_result.start = vec3(0);\n";
  out += "  ts_s = ts_surface; ts_v = ts_view;\n  vec3 ts_whole = ts_sum;\n";
  out += has.defines_finish ? "  ts_result.finish = finish(ts_s, ts_v, ts_whole);\n}\n"
                            : "  ts_result.finish = vec4(ts_whole, 1);\n}\n";
  return out;
}

}  // namespace

CompiledLight compiled_light(const std::string& file, const std::string& text, const ProgramLimits& limits) {
  if (text.size() > limits.source)
    throw Error(ErrorKind::limit, file, "has more than " + std::to_string(limits.source) + " bytes of GLSL",
                "make it shorter");
  if (text.find('\0') != std::string::npos)
    throw Error(ErrorKind::bad_input, file, "is no text", "give GLSL as .glsl, SPIR-V as .spv");
  CompiledLight out;
  try {
    const Definitions definitions(file, text, limits);
    if (!definitions.has("light"))
      throw Error(ErrorKind::bad_input, file, "defines no `vec3 light(Surface s, Light l, View v)`", "define it");
    out.defines_reaches = definitions.has("reaches");
    out.defines_start = definitions.has("start");
    out.defines_finish = definitions.has("finish");
  } catch (const Refusal& refusal) {
    throw Error(refusal.kind, file, refusal.reason, refusal.remedy);
  }
  out.words = spirv_of_glsl(file, text, main_text(out), false, {}, limits);
  return out;
}

}  // namespace trueshade::programs
