#include "oracle/camera_view.h"

#include <cmath>
#include <utility>

#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

Vector4 transformed(const Matrix4& m, const Vector4& v) {
  Vector4 out{};
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) out[r] += m[4 * c + r] * v[c];
  return out;
}

namespace {

/// Gauss with partial pivoting; a singular matrix gives non-finite elements.
Matrix4 inverse(const Matrix4& m) {
  std::array<std::array<double, 8>, 4> a{};
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) a[r][c] = m[4 * c + r];
    a[r][4 + r] = 1;
  }
  for (size_t k = 0; k < 4; ++k) {
    size_t pivot = k;
    for (size_t r = k + 1; r < 4; ++r)
      if (std::fabs(a[r][k]) > std::fabs(a[pivot][k])) pivot = r;
    std::swap(a[k], a[pivot]);
    for (size_t r = 0; r < 4; ++r) {
      if (r == k) continue;
      const double factor = a[r][k] / a[k][k];
      for (size_t c = 0; c < 8; ++c) a[r][c] -= factor * a[k][c];
    }
    for (size_t c = 0; c < 8; ++c)
      if (c != k) a[k][c] /= a[k][k];
    a[k][k] = 1;
  }
  Matrix4 result{};
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) result[4 * c + r] = a[r][4 + c];
  return result;
}

}  // namespace

View view_of(const Scene& scene, const Pipeline& pipeline) {
  View view;
  view.width = pipeline.width;
  view.height = pipeline.height;
  view.near_z = pipeline.geometry.clip_depth == ClipDepth::zero_to_one ? 0 : -1;
  view.flip = pipeline.geometry.clip_origin == ClipOrigin::upper_left;
  view.clip_from_world = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  view.world_from_clip = inverse(view.clip_from_world);
  // The centre of projection has clip x = y = w = 0: the image of (0, 0, 1, 0).
  const Vector4 eye = transformed(view.world_from_clip, {0, 0, 1, 0});
  view.has_eye = std::fabs(eye[3]) > 1e-9 * (std::fabs(eye[0]) + std::fabs(eye[1]) + std::fabs(eye[2]));
  if (view.has_eye) view.eye = {eye[0] / eye[3], eye[1] / eye[3], eye[2] / eye[3]};
  if (!scene.camera.clip_from_world)
    view.eye = {double(scene.camera.eye.x), double(scene.camera.eye.y), double(scene.camera.eye.z)};
  return view;
}

}  // namespace trueshade::oracle
