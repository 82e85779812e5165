#pragma once
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {

/// Notes that a picture calls for once it is drawn: why it is black, how much of it is clamped, and what hides it. Full
/// sentences without their full stops. `to_png`: it is written as a PNG, which holds no value above 1.
std::vector<std::string> picture_notes(const Scene& scene, const Pipeline& pipeline, const Frame& frame, bool to_png);

}  // namespace trueshade
