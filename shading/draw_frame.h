#pragma once
#include "shading/frame.h"

namespace trueshade {

/// Draws the target and the planes that come out of its tiles: geometry pass, light lists, light pass, store. What is
/// made of them afterwards (views, derived planes) is render_frame()'s. `aovs`: as planes_to_draw() gives them.
/// `lit`: false where neither the target nor a plane that shows_light() is wanted: then there is no light pass, no
/// target, and no counts of lit pixels.
Frame draw_frame(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution,
                 std::span<const std::string> aovs, bool lit, const Progress& progress);

}  // namespace trueshade
