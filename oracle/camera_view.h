#pragma once
// The camera in double, without the renderer's matrices: between windows and the world.
#include <array>

#include "oracle/matrices.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

using Vector4 = std::array<double, 4>;

Vector4 transformed(const Matrix4& m, const Vector4& v);

/// The whole image as viewport; x, y in pixels, y up.
struct View {
  Matrix4 clip_from_world, world_from_clip;
  int width, height;
  double near_z;  ///< ndc z of the near plane
  bool flip;      ///< upper_left
  bool has_eye;   ///< all rays pass through `eye`
  std::array<double, 3> eye;

  double ndc_x(double x) const { return 2 * x / width - 1; }
  double ndc_y(double y) const { return flip ? 1 - 2 * y / height : 2 * y / height - 1; }
  std::array<double, 3> world(double x, double y, double z) const {
    const Vector4 p = transformed(world_from_clip, {ndc_x(x), ndc_y(y), z, 1});
    return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
  }
  /// Window x, y in pixels and z in [0, 1].
  std::array<double, 3> window(const std::array<double, 3>& p) const {
    const Vector4 c = transformed(clip_from_world, {p[0], p[1], p[2], 1});
    const double y = c[1] / c[3], z = c[2] / c[3];
    return {(c[0] / c[3] + 1) * width / 2, (flip ? 1 - y : 1 + y) * height / 2, window_z(z)};
  }
  double window_z(double z) const { return near_z < 0 ? (z + 1) / 2 : z; }
};

View view_of(const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade::oracle
