#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/lights_of_ours.h"
#include "scenes/scene.h"
#include "scenes/scene_defaults.h"

namespace trueshade {

enum class DistanceUnit : uint8_t {
  percent,  ///< of the distance from which what is seen fills 85 % of the picture's width or height
  scene_units
};

/// A place on a circle around the vertical axis: y, or z where the scene's camera has exactly that up.
struct OrbitPlace {
  double azimuth_deg = 0.0;    ///< 0: in front, on the side of +z (of -y where z is up); 90: on the right, of +x
  double elevation_deg = 0.0;  ///< in [-90, 90]; 90: straight above
  double distance = 100.0;     ///< above 0; from the point that is looked at
  DistanceUnit unit = DistanceUnit::percent;

  bool operator==(const OrbitPlace&) const = default;
};

/// How a picture is seen otherwise than through the scene's camera. All absent: through that camera.
struct CameraChanges {
  std::optional<OrbitPlace> orbit;       ///< around `target`, else the centre of what is drawn
  std::optional<glm::vec3> eye, target;  ///< world; `eye` not beside `orbit`
  std::optional<double> fov_y_deg;       ///< full vertical angle, in (0, 180)

  bool any() const { return orbit || eye || target || fov_y_deg; }
  bool operator==(const CameraChanges&) const = default;
};

/// The camera that changes make of a scene's.
///
/// A camera of ours (Scene::camera_of_ours) is framed anew for the picture's shape and the angle. An orbit keeps the
/// lens of the scene's camera. An eye without a target looks at the scene camera's target, or where that is a camera of
/// a glTF file, which has none, at the centre of what is drawn. A glTF camera that is moved has the vertical axis up;
/// one that looks along it has up in the picture what an orbit has there. Near and far planes are moved out where they
/// would cut off what is drawn.
///
/// Lamps of ours (scenes/lights_of_ours.h) go around with an orbit.
class ChangedCamera {
 public:
  ChangedCamera() = default;  ///< the scene's own

  /// `scene`: as load_scene() gives it, at its first time, so that a camera does not follow what moves. `aspect`:
  /// width / height of the picture. Error(usage) where the scene's camera is a matrix and the changes do not replace
  /// all of it.
  ChangedCamera(const Scene& scene, const CameraChanges& changes, double aspect);

  /// The camera of the scene as it stands. Error(usage) where validate_camera() refuses it.
  Camera camera(const Scene& scene) const;
  /// Replaces the scene's camera by it, and moves lamps of ours; to be called after each set_time(). Where changes put
  /// the eye below a ground of ours, the ground is moved behind the far plane, for all would lie behind it.
  void see(Scene& scene) const;

 private:
  CameraChanges changes_;
  std::optional<Camera> whole_;  // instead of the scene's, before its parts are replaced
  Bounds bounds_;
  glm::dvec3 up_{0.0, 1.0, 0.0};                                   // the vertical axis
  float near_ = 0.0f, far_ = 0.0f;                                 // of the camera whose parts are replaced
  bool of_file_ = false, ground_ = false;                          // a glTF camera; a ground of ours lies there
  std::optional<std::array<LampPlace, kLightsOfOurs - 1>> lamps_;  // where they are moved to
};

/// The changes of `count` pictures around a scene: orbits at even steps of azimuth from that of `changes` on, all from
/// one distance, from which none of them cuts anything off. Without an orbit from azimuth 0 and an elevation of 20
/// degrees.
std::vector<CameraChanges> turntable(const Scene& scene, const CameraChanges& changes, int count, double aspect);

/// The changes as the command's options say them, like ` --orbit 30,20 --fov 40`; empty where there are none.
std::string option_text(const CameraChanges& changes);

}  // namespace trueshade
