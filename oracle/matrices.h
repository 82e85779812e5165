#pragma once
// Matrices of docs/arithmetic.md section 1, read as mathematics: long double inside, rounded where the page says so.
#include <array>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// clip_from_world as real numbers; the camera's matrix where it has one.
Matrix4 projection_of(const Camera& camera, const GeometryState& state, int width, int height);

/// Its two factors, of a camera that is not a matrix: the view's, and the projection's.
Matrix4 view_matrix(const Camera& camera);
Matrix4 lens_matrix(const Camera& camera, const GeometryState& state, int width, int height);

/// The view's z axis in the world, towards the viewer, of unit length: against the row of w, or, where that has no
/// direction (orthographic), the row of z.
std::array<double, 3> view_axis(const Matrix4& clip_from_world);

/// The inverse by elimination; of a singular matrix, not finite.
Matrix4 inverse_of(const Matrix4& matrix);

/// What takes an instance's vertices to clip and world space, rows, each element rounded to float once.
struct InstanceRows {
  std::array<std::array<float, 4>, 4> clip;
  std::array<std::array<float, 4>, 3> world;
  std::array<std::array<float, 3>, 3> normal;  ///< inverse transpose of the linear part; its cofactors where singular
};
InstanceRows instance_rows(const Instance& instance, const Matrix4& clip_from_world);

}  // namespace trueshade::oracle
