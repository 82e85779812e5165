#pragma once
#include <string>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// Draws a frame, small, and says what is wrong with it; empty: nothing. An infinity is none in a float target: light
/// of 1e18 on a colour of 1e18, or 1 - d / range at a range of 1e-45, is beyond float, and OpenGL stores it so.
std::string fault_of(const Scene& scene, Pipeline pipeline, Format target);

}  // namespace trueshade::testing
