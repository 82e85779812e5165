#pragma once
#include <optional>
#include <vector>

#include "scenes/camera_changes.h"
#include "scenes/pipeline/fit_lights.h"
#include "shading/frame.h"
#include "view/view_state.h"

namespace trueshade::viewer {

/// A scene as a file has it, and as a user has changed its lights, its time and its camera. Meshes are prepared once.
class EditedScene {
 public:
  explicit EditedScene(Scene loaded);
  EditedScene(const EditedScene&) = delete;
  EditedScene& operator=(const EditedScene&) = delete;

  /// Brings the scene to a state: the same scene that loading with these changes and set_time() give. Error as
  /// set_time(); what the scene shows then is not defined until the next call that succeeds.
  void show(const ViewState& state);

  const PreparedScene& prepared() const { return prepared_; }
  const Scene& scene() const { return scene_; }
  const std::vector<Light>& lights_of_file() const { return lights_; }
  const Camera& camera_of_file() const { return moved_camera_; }  ///< at the time of the last show()

 private:
  void change_lights(const ViewState& state);
  void frame(double aspect);

  Scene scene_;
  const std::vector<Light> lights_;  // as they were loaded
  const std::vector<LightMotion> motions_;
  const std::vector<Orbit> orbits_;
  const std::vector<NodeLight> node_lights_;
  const Camera camera_;
  Camera moved_camera_;
  PreparedScene prepared_;
  std::optional<std::vector<LightChange>> changes_;  // that the lights have now
  LightFit fitted_to_;                               // what lights of ours are fitted to now
  ChangedCamera framed_;                             // a camera of ours, for the picture's shape
  double aspect_ = 1.0;                              // that it is framed for
  std::optional<double> time_;                       // that the scene stands at
};

}  // namespace trueshade::viewer
