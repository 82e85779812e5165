#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace trueshade {

/// Vertices of one light's mesh, from object to window.
struct TransformedMesh {
  std::vector<glm::vec3> world;
  std::vector<float> clip[4];
  std::vector<int32_t> x, y;  ///< window, relative to an origin; mean nothing where the vertex needs clipping
  std::vector<double> z;
  std::vector<int32_t> needs_clip;
  bool any_needs_clip = false;
};

}  // namespace trueshade
