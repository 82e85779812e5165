#pragma once
#include <span>

#include "scenes/pipeline.h"
#include "scenes/scene.h"
#include "shading/frame.h"

namespace trueshade {

/// A scene drawn into another's depth: the surfaces of `over` that pass the depth test against `depth`, the stored
/// depth plane of a frame of the same pipeline and camera, as if `over` had been drawn after it. Front faces only, so
/// that a volume about the camera does not hide everything.
///   planes `albedo` and `id.object` of `over`, the latter 0 where the frame stays as it was
struct Overlay {
  Image albedo, object;
};
Overlay overlay(const Scene& over, const Pipeline& pipeline, const Execution& execution, const Image& depth);

}  // namespace trueshade
