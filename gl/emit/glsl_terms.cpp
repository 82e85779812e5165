#include "gl/emit/glsl_terms.h"

#include <sstream>

#include "core/error.h"
#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string declared(const ShaderVariable& v) {
  return v.type + ' ' + v.name + (v.elements > 0 ? '[' + std::to_string(v.elements) + ']' : std::string());
}

Error unknown_to_es(const std::string& what) {
  return {ErrorKind::usage, "--api es31", "OpenGL ES 3.1 has no " + what, "choose another API or pipeline"};
}

/// ES declares no array of inputs; the columns of a matrix are indexed in the same way.
std::string input_matrix(const ShaderVariable& v) {
  const int rows = components_of(v.type);
  return (rows == v.elements ? "mat" + std::to_string(rows)
                             : "mat" + std::to_string(v.elements) + 'x' + std::to_string(rows)) +
         ' ' + v.name;
}

std::string es_line(const Declaration& d, const std::string& line) {
  if (d.qualifier == "noperspective") throw unknown_to_es("noperspective varyings");
  const ShaderVariable& v = d.variable;
  if (d.kind == "uniform" && v.is_buffer()) return "uniform sampler2D " + v.name + ';' + d.comment;
  if (d.kind == "in" && v.elements > 0)
    return "layout(location = " + std::to_string(v.location) + ") in " + input_matrix(v) + ';' + d.comment;
  return line;
}

std::string es_text(const std::string& text) {
  if (text.find("gl_PrimitiveID") != std::string::npos) throw unknown_to_es("gl_PrimitiveID");
  const std::string row = std::to_string(kTexelRow);
  std::string out, lines;
  bool buffers = false;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const Declaration d = declaration_of(line);
    buffers = buffers || d.variable.is_buffer();
    lines += (d.kind.empty() ? line : es_line(d, line)) + '\n';
    if (line.starts_with("#version"))
      lines =
          "#version 310 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
          "precision highp usampler2D;\n";
  }
  for (const ShaderVariable& v : interface_of(text).uniforms)
    if (v.is_buffer()) replace_all(lines, "texelFetch(" + v.name + ", ", "texel_of(" + v.name + ", ");
  if (!buffers) return lines;
  const size_t end = lines.find("usampler2D;\n") + 12;
  return lines.insert(end, "// A texel of a buffer, " + row +
                               " a row.\nvec4 texel_of(sampler2D texels, int i) { return " +
                               "texelFetch(texels, ivec2(i % " + row + ", i / " + row + "), 0); }\n");
}

/// The stage's uniforms but for samplers, with their places said.
std::string block_text(ShaderStage stage, const std::vector<BlockMember>& members) {
  std::string text = "layout(set = 0, binding = " + std::to_string(block_binding(stage)) + ", std140) uniform " +
                     (stage == ShaderStage::vertex ? "VertexUniforms" : "FragmentUniforms") + " {\n";
  for (const BlockMember& m : members)
    text += "  layout(offset = " + std::to_string(m.offset) + ") " + declared(m.variable) + ";\n";
  return text + "};\n";
}

std::string vulkan_text(ShaderStage stage, const std::string& text) {
  const ShaderInterface shader = interface_of(text);
  const std::vector<BlockMember> members = block_of(shader);
  std::string out;
  int varying = 0;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const Declaration d = declaration_of(line);
    const ShaderVariable& v = d.variable;
    if (line.starts_with("#version")) {
      out += "#version 450\n";
      std::getline(in, line);
      out += line + '\n' + (members.empty() ? "" : block_text(stage, members));
    } else if (d.kind == "uniform") {
      if (const int binding = sampler_binding(stage, shader, v.name); binding >= 0)
        out += "layout(set = 0, binding = " + std::to_string(binding) + ") " + line + '\n';
    } else if (!d.kind.empty() && v.location < 0) {
      out += "layout(location = " + std::to_string(varying++) + ") " + line + '\n';
    } else {
      out += line + '\n';
    }
  }
  replace_all(out, "gl_VertexID", "gl_VertexIndex");
  return out;
}

/// A light program's text in Vulkan's terms: a macro gives its block of parameters a binding, and leaves the text
/// alone.
std::string with_binding(std::string text) {
  const size_t line = text.find("#line ");
  return line == std::string::npos
             ? text
             : text.insert(line, "#define uniform layout(set = 0, binding = " + std::to_string(kParameterBinding) +
                                     ") uniform\n");
}

int aligned(int offset, int to) { return (offset + to - 1) / to * to; }

}  // namespace

int sampler_binding(ShaderStage stage, const ShaderInterface& shader, std::string_view name) {
  int binding = stage == ShaderStage::vertex ? 2 : 8;
  for (const ShaderVariable& v : shader.uniforms) {
    if (!v.is_sampler()) continue;
    if (v.name == name) return binding;
    ++binding;
  }
  return -1;
}

std::vector<BlockMember> block_of(const ShaderInterface& shader) {
  std::vector<BlockMember> members;
  int offset = 0;
  for (const ShaderVariable& v : shader.uniforms) {
    if (v.is_sampler()) continue;
    const bool columns = v.type.starts_with("mat");
    const int components = columns ? 4 : components_of(v.type);
    const int alignment = v.elements > 0 || components > 2 ? 16 : 4 * components;
    offset = aligned(offset, alignment);
    members.push_back({v, offset});
    offset += columns ? 64 : v.elements > 0 ? 16 * v.elements : 4 * components;
  }
  return members;
}

int block_bytes(const std::vector<BlockMember>& members) {
  if (members.empty()) return 0;
  const ShaderVariable& last = members.back().variable;
  const int size = last.type.starts_with("mat") ? 64
                   : last.elements > 0          ? 16 * last.elements
                                                : 4 * components_of(last.type);
  return aligned(members.back().offset + size, 16);
}

std::string in_terms_of(ShaderApi api, ShaderStage stage, const std::string& text) {
  const std::string own(own_text(text)), users = text.substr(own.size());
  switch (api) {
    case ShaderApi::gl:
    case ShaderApi::gl33:
      return text;
    case ShaderApi::es31:
      return es_text(own) + users;
    case ShaderApi::vulkan:
      break;
  }
  return vulkan_text(stage, own) + with_binding(users);
}

}  // namespace trueshade::oracle
