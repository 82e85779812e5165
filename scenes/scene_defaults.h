#pragma once
#include <cstdint>
#include <span>

#include "scenes/scene.h"

// What a scene gets where its file says nothing, and the generator of lights that a file can name.
namespace trueshade {

/// Box around all instances, in world space; of radius 1 about the origin if nothing is drawn.
struct Bounds {
  glm::dvec3 centre{0.0};
  double radius = 1.0;  ///< of the sphere around the box
};
Bounds bounds_of(const Scene& scene);

/// A camera above and to the right of the front that sees the whole sphere of `bounds`.
Camera camera_seeing(const Bounds& bounds);

/// Point lights on a circle about the y axis.
struct LightRing {
  uint32_t count = 0;
  glm::dvec3 centre{0.0};
  double radius = 1.0;
  std::span<const glm::vec3> colors;  ///< a ramp around the circle, from the first colour back to it
  double intensity = 1.0;
  double noise = 0.0;  ///< [0, 1]: share of brightness, and of `radius` / 2 in height, that is random
  uint64_t seed = 0;
  float range = std::numeric_limits<float>::infinity();
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};
};
void add_ring(std::vector<Light>& lights, const LightRing& ring);

}  // namespace trueshade
