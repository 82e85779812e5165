#pragma once
#include <array>
#include <string_view>

#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// Ways to draw many lights with OpenGL, which benchmarks compare with ours: the same picture up to rounding.
enum class GlDesign {
  deferred_loop,      ///< one full-screen pass that sums all lights
  deferred_volumes,   ///< the lights' geometry, blended into the target light by light
  tiled,              ///< thin G-buffer (position from depth, half normal), lists by tile within its depth bounds,
                      ///< of lights that its normals look at
  forward_plus,       ///< depth first, then the scene again with the tiles' lists, depth EQUAL
  forward_loop,       ///< the scene once, all lights in each fragment
  forward_multipass,  ///< the scene once a light
};
inline constexpr std::array kGlDesigns{GlDesign::deferred_loop, GlDesign::deferred_volumes,
                                       GlDesign::tiled,         GlDesign::forward_plus,
                                       GlDesign::forward_loop,  GlDesign::forward_multipass};

/// As bench names them: "deferred-loop" and so on.
std::string_view name_of(GlDesign design);

constexpr Strategy strategy_of(GlDesign design) {
  switch (design) {
    case GlDesign::deferred_loop:
    case GlDesign::tiled:
      return Strategy::deferred_loop;
    case GlDesign::deferred_volumes:
      return Strategy::deferred_volumes;
    case GlDesign::forward_plus:
    case GlDesign::forward_loop:
      return Strategy::forward_loop;
    case GlDesign::forward_multipass:
      break;
  }
  return Strategy::forward_multipass;
}

constexpr bool is_forward(GlDesign design) {
  return design == GlDesign::forward_plus || design == GlDesign::forward_loop || design == GlDesign::forward_multipass;
}
constexpr bool is_binned(GlDesign design) { return design == GlDesign::tiled || design == GlDesign::forward_plus; }

/// Whether a design can draw a pipeline's transparent surfaces: into-albedo wants a G-buffer.
constexpr bool draws_glass(GlDesign design, TransparencyMode mode) {
  return mode != TransparencyMode::into_albedo || !is_forward(strategy_of(design));
}

/// The pipeline whose picture a design draws, for render_frame() too. tiled has a thin G-buffer; deferred_volumes draws
/// lights of no given extent, whose falloff ends at their range, as boxes of which front faces are culled.
Pipeline design_pipeline(const Pipeline& pipeline, GlDesign design);

}  // namespace trueshade::oracle
