#pragma once
#include <optional>
#include <span>

#include "scenes/scene.h"
#include "scenes/scene_defaults.h"

namespace trueshade {

/// A camera inside a model that is a room, with the y axis up and a vertical angle of 1.1 rad; nothing for a model that
/// is better seen from outside.
///
/// A model is a room where an eye outside, in the direction `toward`, sees hardly anything but backs of walls; where
/// the walls enclose half of the box around the model; and where more is inside: a thing between the walls, or walls of
/// three materials. (A ball that is turned inside out is none of these but the first.) The eye stands in the room where
/// walls are seen in every direction, as near to the corner below `toward` as it can, and looks at the room's middle. A
/// model of more than 500,000 triangles is not looked at, nor one whose triangles are large and many.
///
/// `instances`: those that count, of `scene`, without a ground. `bounds`: of these. `toward`: world, unit, from the
/// model to the eye outside.
std::optional<Camera> camera_in_room(const Scene& scene, std::span<const Instance> instances, const Bounds& bounds,
                                     const glm::dvec3& toward);

}  // namespace trueshade
