#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace trueshade::oracle {

/// A variable that a shader of ours declares outside its functions.
struct ShaderVariable {
  std::string name, type;  ///< "drawn_light", "int"
  int elements = 0;        ///< of an array; 0: it is none
  int location = -1;       ///< as the text says; -1: it says none
  bool operator==(const ShaderVariable&) const = default;

  bool is_sampler() const { return type.find("sampler") != std::string::npos; }
  bool is_buffer() const { return type == "samplerBuffer"; }
};

/// The variables that the shader reads or writes somewhere: what it declares and never names again is left out.
struct ShaderInterface {
  std::vector<ShaderVariable> inputs, outputs, uniforms;
};

/// Of a text that gl/emit wrote, in OpenGL's terms: one declaration a line; without what a light program declares.
ShaderInterface interface_of(std::string_view shader);

/// A line as a declaration: its kind ("in", "out", "uniform"; empty where it declares nothing) and what stands before
/// that word ("flat"), and the variable.
struct Declaration {
  std::string kind, qualifier, comment;
  ShaderVariable variable;
};
Declaration declaration_of(std::string_view line);

/// Vertex shaders of the scene read what is the same for a whole instance from here on.
inline constexpr int kFirstInstanceLocation = 4;

/// The components of a type and whether they are integers: vec3 3, uvec2 2, float 1.
int components_of(std::string_view type);
bool is_integer(std::string_view type);

}  // namespace trueshade::oracle
