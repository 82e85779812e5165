#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gl/emit/shader_interface.h"

namespace trueshade::oracle {

/// Whose GLSL a shader is written in, and whose state is around it.
enum class ShaderApi : uint8_t {
  gl,     ///< OpenGL 4.5
  gl33,   ///< OpenGL 3.3
  es31,   ///< OpenGL ES 3.1: buffers of texels are textures of kTexelRow texels a row
  vulkan  ///< GLSL 4.50 for SPIR-V: uniforms in a block a stage, bindings in set 0
};
inline constexpr std::string_view kShaderApiNames[] = {"gl", "gl33", "es31", "vulkan"};
inline constexpr int kTexelRow = 1024;

/// GlslOptions::version of the text that in_terms_of() is given.
constexpr int version_of(ShaderApi api) { return api == ShaderApi::gl || api == ShaderApi::vulkan ? 450 : 330; }

enum class ShaderStage : uint8_t { vertex, fragment };

/// A shader of gl/emit, written for OpenGL at version_of(api), in the terms of an API. The statements stay as they are,
/// and so does a light program's text.
/// Throws Error(usage) for what ES has not: `noperspective` and gl_PrimitiveID.
std::string in_terms_of(ShaderApi api, ShaderStage stage, const std::string& text);

/// Vulkan's bindings in set 0: of the block of a stage's uniforms, and of its samplers in the order of their
/// declaration, from 2 and from 8 on; -1 for what is no sampler that the shader reads.
constexpr int block_binding(ShaderStage stage) { return stage == ShaderStage::vertex ? 0 : 1; }
int sampler_binding(ShaderStage stage, const ShaderInterface& shader, std::string_view name);

/// A uniform in such a block: std140, where an array's elements and a matrix's columns are vec4 each.
struct BlockMember {
  ShaderVariable variable;
  int offset = 0;  ///< bytes
};
std::vector<BlockMember> block_of(const ShaderInterface& shader);
int block_bytes(const std::vector<BlockMember>& members);  ///< a multiple of 16

}  // namespace trueshade::oracle
