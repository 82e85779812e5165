#pragma once
#include <vector>

#include "scenes/scene.h"

namespace trueshade {

/// Moves everything in a scene a little from step to step, so that a renderer cannot reuse the previous frame. The
/// camera, each light and each object go round a circle: the radius of the camera's circle is 1 % of the scene's
/// radius, that of a light's 2 %, that of an object's 0.2 %. The lights and the objects start at different angles.
/// Directional lights swing by about 3 degrees. Meshes keep their shapes. The class borrows the scene; the destructor
/// puts everything back.
class MovingScene {
 public:
  static constexpr int kSteps = 64;  ///< steps of a full circle

  explicit MovingScene(Scene& scene);
  ~MovingScene();
  MovingScene(const MovingScene&) = delete;
  MovingScene& operator=(const MovingScene&) = delete;

  /// Moves the scene to where it is after `step` steps, in [0, 2^30].
  void move_to(int step);

 private:
  Scene& scene_;
  const std::vector<Instance> instances_;  // where they were
  const std::vector<Light> lights_;
  const Camera camera_;
  double radius_;
};

}  // namespace trueshade
