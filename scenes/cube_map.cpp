#include "scenes/cube_map.h"

#include "core/fp_env.h"

namespace trueshade {
namespace {

/// Unit vectors of the world: where the camera looks, and where the face's s and t grow.
struct FaceAxes {
  glm::dvec3 forward, s, t;
};

/// Table 8.19 of OpenGL 4.6: s = (sc / |major| + 1) / 2 and t = (tc / |major| + 1) / 2 with sc and tc of the face.
constexpr FaceAxes kAxes[] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                              {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                              {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};

}  // namespace

Camera cube_face_camera(const Camera& camera, glm::vec3 eye, CubeFace face) {
  const FpScope fp;
  const FaceAxes& axes = kAxes[size_t(face)];
  const glm::dvec3 from(eye);
  const double near = camera.near, far = camera.far;
  const double scale = (far + near) / (far - near), offset = 2.0 * (far * near) / (far - near);
  // Rows of x, y, z and w: what of a point in the world each is, and what of the origin.
  const glm::dvec3 rows[4] = {axes.s, axes.t, axes.forward * scale, axes.forward};
  Camera result = camera;
  result.eye = eye;
  result.clip_from_world.emplace();
  for (size_t row = 0; row < 4; ++row) {
    for (size_t column = 0; column < 3; ++column)
      (*result.clip_from_world)[4 * column + row] = float(rows[row][glm::length_t(column)]);
    const glm::dvec3& r = rows[row];
    const double at_origin = -((r.x * from.x + r.y * from.y) + r.z * from.z) - (row == 2 ? offset : 0.0);
    (*result.clip_from_world)[12 + row] = float(at_origin);
  }
  result.matrix_has_gl_range = true;
  return result;
}

}  // namespace trueshade
