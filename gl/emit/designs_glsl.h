#pragma once
#include <string>

#include "gl/emit/designs.h"
#include "gl/emit/glsl.h"

namespace trueshade::oracle {

/// Vertex and fragment shader of the pass that lights: over the image, over the lights' geometry, over tiles, or over
/// the scene.
struct DesignShaders {
  std::string vert, frag;
};
DesignShaders lighting_shaders(const Pipeline& pipeline, const GlslOptions& options, GlDesign design);

/// Writes what a surface has without lights: what deferred_volumes blends onto.
std::string base_fragment_text(const Pipeline& pipeline, const GlslOptions& options);

/// Depth alone.
std::string empty_fragment_text(int version);

}  // namespace trueshade::oracle
