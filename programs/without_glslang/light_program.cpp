// In place of front/ in a build without glslang: no text becomes a program.
#include "programs/front/light_program.h"

#include "core/error.h"
#include "programs/front/light_outline.h"

namespace trueshade::programs {
namespace {

[[noreturn]] void refuse(const std::string& file) {
  throw Error(ErrorKind::usage, file, "light programs, as explain and validate read every light model, are left out of this build, which found no glslang",
              "install glslang-dev and spirv-tools, and build anew");
}

}  // namespace

Program program_from_glsl(const std::string& file, const std::string&, const ProgramLimits&) { refuse(file); }
Program program_from_spirv(const std::string& file, std::vector<uint32_t>, const ProgramLimits&) { refuse(file); }
std::shared_ptr<const Program> kept_program(const std::string& file, const std::string&) { refuse(file); }
std::string_view light_interface() { return {}; }
LightOutline light_outline(const std::string& file, const std::string&) { refuse(file); }

}  // namespace trueshade::programs
