#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <optional>

namespace trueshade {

/// 4x4 of doubles, column-major as OpenGL: element (row r, column c) is m[4 * c + r].
using Matrix4 = std::array<double, 16>;

/// Where the scene is seen from. Right-handed, looking from eye to target; or a matrix handed over by an engine.
struct Camera {
  glm::vec3 eye{0.0f, 0.0f, 5.0f};  ///< world; also the viewer of specular terms
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float fov_y_rad = 0.8f;                                ///< full vertical angle, in (0, pi)
  std::optional<float> fov_x_rad;                        ///< full horizontal angle, in (0, pi); replaces fov_y_rad
  float near = 0.1f, far = 1000.0f;                      ///< 0 < near < far
  std::optional<std::array<float, 16>> clip_from_world;  ///< column-major; replaces all but `eye`
  /// Whether clip_from_world has z in [-w, w] for every pipeline, so that ClipRange::zero_to_one reads (z + w) / 2: a
  /// matrix of ours. The range of an engine's matrix is the engine's.
  bool matrix_has_gl_range = false;
};

/// Range of z in clip space: -w <= z <= w, or 0 <= z <= w.
enum class ClipRange : uint8_t { negative_one_to_one, zero_to_one };

/// Clip space (-w <= x, y <= w) from world space, in the operations of docs/arithmetic.md; `aspect` = width / height. A
/// matrix handed over by an engine is taken as it is, a matrix of ours with the z of the range.
Matrix4 clip_from_world(const Camera& camera, double aspect, ClipRange range = ClipRange::negative_one_to_one);

/// Its two factors, of a camera that is not a matrix: view space has the eye at 0, looking along -z, y up.
Matrix4 clip_from_view(const Camera& camera, double aspect, ClipRange range);
Matrix4 view_from_world(const Camera& camera);  ///< the second of the two

/// The view's z axis in the world, from the scene to the viewer, of unit length: minus the row of w, or where that has
/// no direction (an orthographic matrix) minus the row of z. OpenGL's viewer at infinity, (0, 0, 1) in eye space.
glm::vec3 view_axis(const Camera& camera);

/// a * b, each element ((a0*b0 + a1*b1) + a2*b2) + a3*b3.
Matrix4 product(const Matrix4& a, const Matrix4& b);

}  // namespace trueshade
