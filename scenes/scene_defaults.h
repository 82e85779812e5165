#pragma once
#include <glm/vec2.hpp>
#include <optional>

#include "scenes/scene.h"

// What a scene gets where its file says nothing.
namespace trueshade {

/// Box around all instances, in world space; of radius 1 about the origin if nothing is drawn.
struct Bounds {
  glm::dvec3 centre{0.0};
  double radius = 1.0;     ///< of the sphere around the box
  glm::dvec3 least{-1.0};  ///< the box's lowest corner
};
Bounds bounds_of(const Scene& scene);
/// The same of all but the ground of ours.
Bounds bounds_without_ground(const Scene& scene);

/// A side to see a scene from, and a lens.
struct SeenFrom {
  glm::dvec3 toward, right, up;      ///< world, unit, at right angles: to the eye; right and up in the picture
  glm::dvec2 slope;                  ///< tangents of half the angles that are seen across the picture and up it
  std::optional<glm::dvec3> target;  ///< in the picture's middle; nothing: the middle of what is seen is there
  bool both_middles = false;         ///< also along the side of the picture that is not full
};

/// How far off the eye is to be.
struct Framing {
  Bounds bounds;         ///< without ground
  glm::dvec3 target;     ///< world
  double distance;       ///< from target to eye, scene units: the most that is seen fills 85 % of the width or height
  double front, behind;  ///< along SeenFrom::toward, from the target to the nearest and to the farthest point
};
Framing framing_of(const Scene& scene, const SeenFrom& view);

/// Whether turn_of_side() and so camera_seeing() look at the triangles of a scene, and not at its vertices alone: at
/// those of a glTF model of at most 2,000,000.
bool looks_at_faces(const Scene& scene);

/// How far the side that camera_seeing() looks from is turned from the front, +z, to the right: the sine and the cosine
/// of the angle. (0, 1) but for a glTF model that shows hardly anything but backs there, which are not drawn: then it
/// is the side, of the front, the back and both others, where most fronts are seen.
glm::dvec2 turn_of_side(const Scene& scene);

/// Of cameras of ours, from the bottom of the picture to its top.
inline constexpr float kFovOfOurs_rad = 0.5f;

/// A camera above and to the right of the front, or of the side of turn_of_side(), that sees all that is drawn: it
/// fills 85 % of the width or of the height of a picture of this aspect, width / height, and is in the middle.
/// `fov_y_rad`: full vertical angle.
Camera camera_seeing(const Scene& scene, double aspect = 1.0, float fov_y_rad = kFovOfOurs_rad);

/// Gives a scene without a camera one of ours: that of camera_seeing() for square pictures or, of a model that is a
/// room, that of camera_in_room() (scenes/room.h).
void add_camera_of_ours(Scene& scene);

}  // namespace trueshade
