#include "scenes/scene_defaults.h"

#include <algorithm>
#include <cmath>

#include "scenes/trig.h"

namespace trueshade {

Bounds bounds_of(const Scene& scene) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<glm::dvec3> low(scene.meshes.size(), glm::dvec3(kInfinity)),
      high(scene.meshes.size(), glm::dvec3(-kInfinity));
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (int k = 0; k < 3; ++k)
      for (const float p : scene.meshes[m].position[size_t(k)]) {
        low[m][k] = std::min(low[m][k], double(p));
        high[m][k] = std::max(high[m][k], double(p));
      }
  glm::dvec3 least(kInfinity), most(-kInfinity);
  for (const Instance& instance : scene.instances) {
    if (scene.meshes[instance.mesh].vertex_count() == 0) continue;
    for (int corner = 0; corner < 8; ++corner) {
      glm::dvec3 at(instance.world_from_object[3]);
      for (int k = 0; k < 3; ++k)
        at += glm::dvec3(instance.world_from_object[k]) * (corner >> k & 1 ? high : low)[instance.mesh][k];
      for (int k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], at[k]);
        most[k] = std::max(most[k], at[k]);
      }
    }
  }
  if (!(least.x <= most.x)) return {};
  const glm::dvec3 diagonal = most - least;
  const double radius = 0.5 * std::sqrt(dot(diagonal, diagonal));
  return {(least + most) * 0.5, radius > 0.0 ? radius : 1.0, least};
}

Camera camera_seeing(const Bounds& bounds) {
  Camera camera;
  camera.fov_y_rad = 0.7f;
  const double distance = bounds.radius / sine(0.5 * double(camera.fov_y_rad));
  camera.eye = glm::vec3(bounds.centre + unit({0.35, 0.3, 1.0}) * distance);
  camera.target = glm::vec3(bounds.centre);
  camera.near = float(0.2 * (distance - bounds.radius));
  camera.far = float(distance + 4.0 * bounds.radius);
  return camera;
}

}  // namespace trueshade
