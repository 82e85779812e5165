#pragma once
#include <string>

#include "gl/emit/glsl.h"

namespace trueshade::oracle {

/// All that a program needs to set up around the shaders of shaders_of(), as JSON for people: GL calls as they are
/// written in C, planes with their formats, attributes, samplers, uniforms and the layout of the light records.
std::string state_list(const Pipeline& pipeline, const GlslOptions& options);

}  // namespace trueshade::oracle
