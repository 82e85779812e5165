#pragma once
// The axes of the camera's view space in the world.
#include <array>

#include "judge/diagnosis/triple.h"
#include "scenes/camera.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// The directions of the camera's right, up, and towards the viewer, in world space, of unit length. They come from the
/// rows of `clip_from_world` (docs/captures.md, "Axes of a view space"). Left-handed where the matrix mirrors.
std::array<Triple3, 3> view_axes(const Camera& camera, const Pipeline& pipeline);

}  // namespace trueshade::oracle
