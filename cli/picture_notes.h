#pragma once
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {

/// Why nothing of the scene is drawn; empty where something is. A note is a full sentence without its full stop.
std::string empty_note(const Scene& scene, const FrameStats& stats);

/// Notes that a picture calls for once it is drawn: why it is black, how much of it is clamped, and what hides it.
/// `to_png`: it is written as it is into a PNG, which holds no value above 1. `exposed`: an exposure was chosen, so
/// that none advises one.
std::vector<std::string> picture_notes(const Scene& scene, const Pipeline& pipeline, const Frame& frame, bool to_png,
                                       bool exposed);

}  // namespace trueshade
