#pragma once
#include <array>

#include "cli/capture/capture_map.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

using Real3 = std::array<double, 3>;

/// The camera of a capture, in double: the axes of its view space in the world, and points on the rays of pixels.
class CameraFrame {
 public:
  /// Finds the axes and the eye. They mean nothing where check_axes() throws.
  CameraFrame(const Scene& scene, const Pipeline& pipeline);

  /// Turns a direction given in `space` into the world's axes. Call check_axes() first, for a view space.
  Real3 world_direction(CapturedSpace space, const Real3& n) const;
  /// Turns a position given in `space` into the world's. Call check_axes() first, for a view space.
  Real3 world_position(CapturedSpace space, const Real3& p) const;
  /// Throws Error(bad_input) where the camera's matrix is sheared or has no inverse, so that view space has no axes.
  void check_axes() const;

  /// The world position where all rays meet; of an orthographic camera the scene's camera position.
  const Real3& eye() const { return eye_; }

  /// The world position on the ray of pixel (x, y)'s centre, y from the top, at a distance along the camera's axis,
  /// scene units.
  Real3 at_linear(int x, int y, double depth) const;
  /// The world position on the ray of pixel (x, y)'s centre, y from the top, at a distance from the eye, scene units;
  /// of an orthographic camera, at a distance along its axis.
  Real3 at_distance(int x, int y, double distance) const;
  /// The world position on the ray of pixel (x, y)'s centre, y from the top, at a window depth.
  Real3 at_window(int x, int y, double depth) const;
  /// The window depth of a world position, not clamped; infinite or NaN in the plane of the eye.
  double window_depth(const Real3& point) const;

 private:
  double clip(size_t row, const Real3& p) const {
    return matrix_[row] * p[0] + matrix_[4 + row] * p[1] + matrix_[8 + row] * p[2] + matrix_[12 + row];
  }
  Real3 clip_row(size_t row) const { return {matrix_[row], matrix_[4 + row], matrix_[8 + row]}; }
  std::array<double, 2> ndc(int x, int y) const;

  const GeometryState geometry_;
  const int height_;
  Viewport viewport_;
  Matrix4 matrix_, inverse_;
  Real3 right_, up_, forward_, eye_;
  double w_per_unit_;  ///< how much w grows by a step forward of length 1; 0 of orthographic cameras
};

}  // namespace trueshade
