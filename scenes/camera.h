#pragma once
#include <array>
#include <optional>

#include <glm/vec3.hpp>

namespace trueshade {

/// 4x4 of doubles, column-major as OpenGL: element (row r, column c) is m[4 * c + r].
using Matrix4 = std::array<double, 16>;

/// Where the scene is seen from. Right-handed, looking from eye to target; or a matrix handed over by an engine.
struct Camera {
  glm::vec3 eye{0.0f, 0.0f, 5.0f};  ///< world; also the viewer of specular terms
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float fov_y_rad = 0.8f;           ///< full vertical angle, in (0, pi)
  float near = 0.1f, far = 1000.0f; ///< 0 < near < far
  std::optional<std::array<float, 16>> clip_from_world;  ///< column-major; replaces all but `eye`
};

/// Clip space from world space, in the operations of docs/arithmetic.md; `aspect` = width / height. Visible depths are
/// -w <= z <= w, or 0 <= z <= w under `zero_to_one`. A matrix handed over is taken as it is.
Matrix4 clip_from_world(const Camera& camera, double aspect, bool zero_to_one);

}  // namespace trueshade
