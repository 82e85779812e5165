#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scenes/camera.h"

namespace trueshade::viewer {

/// What moves the camera in one step of the window.
struct CameraInput {
  glm::dvec3 fly{0.0};    ///< right, up, forward: -1, 0 or 1 each
  double pace = 1.0;      ///< multiplies the speed
  glm::dvec2 turn{0.0};   ///< by how much to look right and up, radians
  glm::dvec2 orbit{0.0};  ///< by how much to go round the pivot to the right and up, radians
  double nearer = 0.0;    ///< steps towards the pivot, a tenth of the way each

  bool rests() const {
    return fly == glm::dvec3(0.0) && turn == glm::dvec2(0.0) && orbit == glm::dvec2(0.0) && nearer == 0.0;
  }
};

/// A camera that flies, looks around and orbits. Right-handed; `up` stays as it was, and the view keeps a degree away
/// from it. The pivot is the camera's target.
class CameraControls {
 public:
  /// `reach`: the radius of what there is to see, scene units. A camera given by a matrix becomes one with a field of
  /// view: the nearest that looks from the same place in the same direction.
  CameraControls(const Camera& from, double reach);

  /// Moves for so many seconds. Flight begins and ends within a tenth of a second, not at once.
  void step(const CameraInput& input, double seconds);
  bool flies() const { return velocity_ != glm::dvec3(0.0); }  ///< still, after the keys are released

  Camera camera() const;
  double speed() const { return speed_; }  ///< scene units a second
  void change_speed(double steps);         ///< by a fifth a step, between a millionth and a thousand of the reach
  void set_field_of_view(double radians);  ///< vertical or horizontal, as the camera has it; from 0.1 to 179.9 degrees
  double field_of_view() const;
  void set_pivot(const glm::dvec3& point);  ///< looks at it from where the camera is

 private:
  glm::dvec3 forward() const;
  void aim(const glm::dvec3& direction);
  void turn(double right, double up);

  Camera lens_;                         // field of view, near and far; and up
  glm::dvec3 eye_, up_, side_, ahead_;  // up_, side_, ahead_: unit, at right angles; yaw is measured from ahead_
  double yaw_ = 0.0, pitch_ = 0.0;      // radians
  double reach_;
  double distance_;  // to the pivot
  double speed_;
  glm::dvec3 velocity_{0.0};  // right, up, forward; scene units a second
};

/// The camera without a matrix that is nearest to a camera with one, see CameraControls.
Camera camera_with_lens(const Camera& camera, double reach);

}  // namespace trueshade::viewer
