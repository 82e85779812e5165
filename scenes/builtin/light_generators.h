#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "scenes/scene.h"

// Makers of many point lights at once, for scene files and for geometry files that come without a scene.
namespace trueshade {

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
  double turn_s = 0.0;  ///< seconds in which the ring goes round; 0: it stands
};
void add_ring(Scene& scene, const LightRing& ring);

/// Point lights spread evenly at random in a box, each of one of the colours.
struct LightBox {
  uint32_t count = 0;
  glm::dvec3 from{0.0}, to{1.0};
  std::span<const glm::vec3> colors;
  double intensity = 1.0;
  double noise = 0.0;  ///< [0, 1]: share of brightness that is random
  uint64_t seed = 0;
  float range = std::numeric_limits<float>::infinity();
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};
  double drift = 0.0;     ///< radius of the circle each goes round, level, scene units
  double drift_s = 10.0;  ///< seconds in which it does; each light between 3/4 and 5/4 of it
};
void add_box(Scene& scene, const LightBox& box);

}  // namespace trueshade
