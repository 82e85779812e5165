#pragma once
#include "scenes/scene.h"

// What a scene gets where its file says nothing.
namespace trueshade {

/// Box around all instances, in world space; of radius 1 about the origin if nothing is drawn.
struct Bounds {
  glm::dvec3 centre{0.0};
  double radius = 1.0;     ///< of the sphere around the box
  glm::dvec3 least{-1.0};  ///< the box's lowest corner
};
Bounds bounds_of(const Scene& scene);

/// A camera above and to the right of the front that sees all that is drawn: in a square picture it fills 85 % of the
/// width or of the height, and is in the middle.
Camera camera_seeing(const Scene& scene);

}  // namespace trueshade
