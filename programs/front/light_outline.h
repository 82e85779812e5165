#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "programs/front/light_program.h"

namespace trueshade::programs {

/// A scalar of the block of parameters, "parameters.tint.y", and where std140 has it.
struct ParameterPlace {
  std::string name;
  Type type = Type::f32;
  uint32_t offset = 0;  ///< bytes
};

/// A variable of the whole file that is no constant.
struct FileVariable {
  std::string type, name;
  std::string zero;  ///< what it is before it is written: an expression of GLSL; empty where the file says it
};

/// What a shader of a driver must know of the light program whose text it contains.
struct LightOutline {
  bool defines_reaches = false, defines_start = false, defines_finish = false;
  std::vector<std::string> inputs;    ///< scalars that it reads, as Program has them
  std::vector<std::string> declared;  ///< Program::parameters
  std::string parameter_block;        ///< the name of the block of parameters; empty: there is none
  std::vector<ParameterPlace> parameters;
  uint32_t parameter_bytes = 0;  ///< of the block, a multiple of 16
  std::vector<FileVariable> variables;
};

/// programs/light_interface.glsl, which stands before the text.
std::string_view light_interface();

/// Error as of program_from_glsl(); Error(usage) where the text is SPIR-V.
LightOutline light_outline(const std::string& file, const std::string& text);

}  // namespace trueshade::programs
