#pragma once
#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A scene drawn into another's depth: the surfaces of `over` that pass the depth test against `depth`, the stored
/// depth plane of a frame of the same pipeline and camera, as if `over` had been drawn after it. Front faces only, so
/// that a volume about the camera does not hide everything. Returns the plane id.object of `over`, 0 where the frame
/// stays as it was. Needs FpScope.
Image overlay(const Scene& over, const Pipeline& pipeline, const Execution& execution, const Image& depth);

/// The colour of an instance of such a scene, all of its material: `object` is its index + 1.
inline glm::vec3 overlay_color(const Scene& over, uint32_t object) {
  return glm::vec3(over.materials[over.instances[object - 1].material].base_color);
}

}  // namespace trueshade
