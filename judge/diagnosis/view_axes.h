#pragma once
// The axes of the camera's view space in the world.
#include <array>

#include "judge/diagnosis/triple.h"
#include "scenes/camera.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// The directions right, up, and towards the viewer, of unit length, from the rows of `clip_from_world`
/// (docs/captures.md, "Axes of a view space"). A matrix that mirrors gives axes that are left-handed.
std::array<Triple3, 3> view_axes(const Camera& camera, const Pipeline& pipeline);

}  // namespace trueshade::oracle
