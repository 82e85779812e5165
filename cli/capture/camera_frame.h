#pragma once
#include <array>

#include "cli/capture/capture_map.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

using Real3 = std::array<double, 3>;

/// The camera of a capture in double: its axes in the world, and where a pixel's ray is at a depth.
class CameraFrame {
 public:
  /// Finds the axes and the eye. They are meaningless where check_axes() throws.
  CameraFrame(const Scene& scene, const Pipeline& pipeline);

  /// A direction of `space`, in the world. Call check_axes() before, for a view space.
  Real3 world_direction(CapturedSpace space, const Real3& n) const;
  /// A position of `space`, in the world. Call check_axes() before, for a view space.
  Real3 world_position(CapturedSpace space, const Real3& p) const;
  /// Error(bad_input) where the matrix is sheared or has no inverse, so that view space has no axes.
  void check_axes() const;

  /// Where all rays meet; of an orthographic matrix the scene's camera.
  const Real3& eye() const { return eye_; }

  /// The point of a pixel's ray (pixel centre, y from the top) at a distance along the camera's axis.
  Real3 at_linear(int x, int y, double depth) const;
  /// The point of a pixel's ray at a distance from the eye; of an orthographic camera along its axis.
  Real3 at_distance(int x, int y, double distance) const;
  /// The point of a pixel's ray at a window depth.
  Real3 at_window(int x, int y, double depth) const;
  /// The window depth of a point, not clamped; infinite or NaN in the eye's plane.
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
