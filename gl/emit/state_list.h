#pragma once
#include <string>
#include <utility>
#include <vector>

#include "gl/emit/glsl.h"
#include "gl/emit/glsl_terms.h"

namespace trueshade::oracle {

/// Shaders by the names of their files: those of shaders_of() and of the post chain.
using ShaderTexts = std::vector<std::pair<std::string, std::string>>;
ShaderTexts gl_shader_files(const Pipeline& pipeline, const GlslOptions& options);

/// The same in an API's terms. `options.version` must be version_of(api). Error(usage) for what the API has not.
ShaderTexts shader_files(const Pipeline& pipeline, const GlslOptions& options, ShaderApi api);

/// All that a program needs to set up around these shaders, as members of a JSON object for people, without its braces:
/// the state as calls (of Vulkan, as fields), planes with their formats, attributes, samplers, uniforms and the layout
/// of the light records. Names that no shader reads are left out.
std::string state_list(const Pipeline& pipeline, const GlslOptions& options, ShaderApi api);

}  // namespace trueshade::oracle
