#pragma once
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace trueshade {

/// Where an object stands: a scale, then a turn, then a move.
struct Placement {
  glm::dvec3 position{0.0};                 ///< scene units
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion x, y, z, w
  glm::dvec3 scale{1.0};
};

/// The affine matrix of a placement, each element rounded once to float (docs/arithmetic.md, section 1).
glm::mat4x3 world_from_object(const Placement& placement);

/// A placement as a copy of it elsewhere has it: the copy's turn comes after, its position is added, its scale
/// multiplies.
Placement copied(const Placement& placement, const Placement& copy);

/// The turn `first`, then the turn `then`: the quaternion product then * first.
glm::dvec4 turned(const glm::dvec4& first, const glm::dvec4& then);

/// Turn by an angle about axis 0, 1 or 2.
glm::dvec4 turn_about(int axis, double angle_rad);

/// q * (1 / |q|); 0 stays 0.
glm::dvec4 unit(const glm::dvec4& q);

/// Whether an affine matrix, in f64, has a negative determinant.
bool mirrors(const glm::mat4x3& matrix);

}  // namespace trueshade
