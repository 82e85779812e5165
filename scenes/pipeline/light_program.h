#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace trueshade {

/// A value for a member of a light program's block `Parameters`: a number, or the components of a vector.
struct ProgramParameter {
  std::string name;
  std::vector<float> value;
  bool operator==(const ProgramParameter&) const = default;
};

/// A light model of the user's own, in place of the formula that LightModel states: docs/light_programs.md.
struct LightProgram {
  std::string file;    ///< names it in messages and in what a picture carries; empty: there is none
  std::string text;    ///< GLSL, or the bytes of SPIR-V; empty where a pipeline's JSON names a program
  std::string sha256;  ///< of the text, as a pipeline's JSON has it; empty: not known
  std::vector<ProgramParameter> parameters;
  bool used() const { return !file.empty(); }
  bool operator==(const LightProgram&) const = default;
};

/// Whether a program's text is SPIR-V, which begins with 0x07230203, and not GLSL.
inline bool is_spirv(std::string_view text) { return text.starts_with(std::string_view("\x03\x02\x23\x07", 4)); }

}  // namespace trueshade
