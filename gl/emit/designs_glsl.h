#pragma once
#include <string>

#include "gl/driver/designs.h"

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

inline bool is_forward(GlDesign design) {
  return design == GlDesign::forward_plus || design == GlDesign::forward_loop || design == GlDesign::forward_multipass;
}
inline bool is_tiled(GlDesign design) { return design == GlDesign::tiled || design == GlDesign::tiled_thin; }
inline bool is_binned(GlDesign design) { return is_tiled(design) || design == GlDesign::forward_plus; }

}  // namespace trueshade::oracle
