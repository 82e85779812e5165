#pragma once
#include <vector>

#include "scenes/scene.h"

namespace trueshade {

/// A scene of which everything moves a little: no frame is the one before, whatever a renderer remembers of that. The
/// camera, the lights and the objects go round circles, the camera's of 1 %, lights' of 2 % and objects' of 0.2 % of
/// the scene's radius, each light and object from an angle of its own; directional lights swing by about 3 degrees.
/// Meshes stay. Borrows the scene, and leaves it where it was.
class MovingScene {
 public:
  static constexpr int kSteps = 64;  ///< once round

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
