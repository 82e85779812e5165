#pragma once
#include "shading/frame.h"

namespace trueshade {

/// Draws the target and the planes that are drawn tile by tile: geometry pass, light lists, light pass, store. Views
/// and derived planes, which are made of these afterwards, are render_frame()'s. `aovs` come from planes_to_draw().
/// `lit` is false if neither the target nor a plane that shows_light() is wanted; then there is no light pass, no
/// target and no counts of lit pixels.
Frame draw_frame(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                 std::span<const std::string> aovs, bool lit, const Progress& progress);

}  // namespace trueshade
