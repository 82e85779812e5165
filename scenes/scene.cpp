#include "scenes/scene.h"

#include <algorithm>
#include <cmath>

#include "core/fp_env.h"

namespace trueshade {

float shininess_of_roughness(float roughness) {
  const FpScope fp;
  const double r = std::max(double(roughness), 0.04), r2 = r * r;
  return float(std::clamp(std::nearbyint(2.0 / (r2 * r2) - 2.0), 1.0, 8192.0));
}

uint64_t Scene::triangle_count() const {
  uint64_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangle_count();
  return count;
}

glm::dvec3 reach_of(const Mesh& mesh) {
  const FpScope fp;
  glm::dvec3 reach(0.0);
  for (size_t c = 0; c < 3; ++c)
    for (const float x : mesh.position[c]) reach[int(c)] = std::max(reach[int(c)], std::abs(double(x)));
  return reach;
}

}  // namespace trueshade
