#include "scenes/camera.h"

#include "core/fp_env.h"
#include "scenes/hierarchy.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

double& at(Matrix4& m, int row, int column) { return m[size_t(4 * column + row)]; }

}  // namespace

Matrix4 clip_from_view(const Camera& camera, double aspect, ClipRange range) {
  const FpScope fp;
  const bool zero_to_one = range == ClipRange::zero_to_one;
  Matrix4 m{};
  if (camera.fov_x_rad) {
    const double g = 1.0 / tangent(double(*camera.fov_x_rad) / 2.0);
    at(m, 0, 0) = g;
    at(m, 1, 1) = g * aspect;
  } else {
    const double g = 1.0 / tangent(double(camera.fov_y_rad) / 2.0);
    at(m, 0, 0) = g / aspect;
    at(m, 1, 1) = g;
  }
  const double near = camera.near, far = camera.far;
  at(m, 2, 2) = (zero_to_one ? far : far + near) / (near - far);
  at(m, 2, 3) = (zero_to_one ? far * near : 2.0 * (far * near)) / (near - far);
  at(m, 3, 2) = -1.0;
  return m;
}

Matrix4 product(const Matrix4& a, const Matrix4& b) {
  const FpScope fp;
  Matrix4 m{};
  for (size_t c = 0; c < 4; ++c)
    for (size_t r = 0; r < 4; ++r)
      m[4 * c + r] = ((a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1]) + a[8 + r] * b[4 * c + 2]) + a[12 + r] * b[4 * c + 3];
  return m;
}

Matrix4 view_from_world(const Camera& camera) {
  const FpScope fp;
  const glm::dvec3 eye(camera.eye), target(camera.target), up(camera.up);
  const glm::dvec3 forward = unit(target - eye);
  const glm::dvec3 side = unit(cross(forward, up));
  const glm::dvec3 rows[3] = {side, cross(side, forward), -forward};
  Matrix4 m{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) at(m, r, c) = rows[r][c];
    at(m, r, 3) = -dot(rows[r], eye);
  }
  at(m, 3, 3) = 1.0;
  return m;
}

Matrix4 clip_from_world(const Camera& camera, double aspect, ClipRange range) {
  const FpScope fp;
  if (!camera.clip_from_world) return product(clip_from_view(camera, aspect, range), view_from_world(camera));
  Matrix4 m{};
  for (size_t i = 0; i < 16; ++i) m[i] = double((*camera.clip_from_world)[i]);
  if (camera.matrix_has_gl_range && range == ClipRange::zero_to_one)
    for (int c = 0; c < 4; ++c) at(m, 2, c) = (at(m, 2, c) + at(m, 3, c)) / 2.0;
  return m;
}

glm::vec3 view_axis(const Camera& camera) {
  const FpScope fp;
  if (!camera.clip_from_world) return glm::vec3(-unit(glm::dvec3(camera.target) - glm::dvec3(camera.eye)));
  const std::array<float, 16>& m = *camera.clip_from_world;
  const glm::dvec3 w(m[3], m[7], m[11]);
  return glm::vec3(-unit(dot(w, w) > 0.0 ? w : glm::dvec3(m[2], m[6], m[10])));
}

}  // namespace trueshade
