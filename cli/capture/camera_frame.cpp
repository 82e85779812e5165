#include "cli/capture/camera_frame.h"

#include <cmath>

#include "core/error.h"
#include "oracle/camera_view.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"
#include "oracle/scalar_renderer.h"

namespace trueshade {
namespace {

double dot3(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
/// a + share * b
Real3 plus(const Real3& a, const Real3& b, double share) {
  return {a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]};
}
Real3 crossed(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// A vector made unit length; NaN of a vector of length 0.
Real3 unit3(const Real3& a) {
  const double length = std::sqrt(dot3(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace

CameraFrame::CameraFrame(const Scene& scene, const Pipeline& pipeline)
    : geometry_(pipeline.geometry),
      height_(pipeline.height),
      viewport_(oracle::resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height)),
      matrix_(oracle::projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)),
      inverse_(oracle::inverse_of(matrix_)) {
  const Real3 w = clip_row(3);
  w_per_unit_ = std::sqrt(dot3(w, w));
  const Real3 back = oracle::view_axis(matrix_);
  const bool farther_is_less = geometry_.depth_func == DepthFunc::greater || geometry_.depth_func == DepthFunc::gequal;
  const double sign = w_per_unit_ == 0 && farther_is_less && geometry_.depth_near <= geometry_.depth_far ? 1 : -1;
  forward_ = {sign * back[0], sign * back[1], sign * back[2]};
  const auto across = [&](size_t row, double turned) {
    const Real3 r = clip_row(row);
    return unit3(plus({turned * r[0], turned * r[1], turned * r[2]}, forward_, -turned * dot3(r, forward_)));
  };
  right_ = across(0, 1);
  up_ = across(1, geometry_.clip_origin == ClipOrigin::upper_left ? -1 : 1);
  eye_ = {double(scene.camera.eye.x), double(scene.camera.eye.y), double(scene.camera.eye.z)};
  if (const oracle::View view = oracle::view_of(scene, pipeline); view.has_eye) eye_ = view.eye;
}

void CameraFrame::check_axes() const {
  const double sheared = std::fabs(dot3(right_, up_));
  if (!(sheared < 1e-5) || !std::isfinite(inverse_[0]))
    throw Error(ErrorKind::bad_input, "camera", "its matrix is sheared or has no inverse, so there is no view space",
                "capture positions and normals of the world");
}

Real3 CameraFrame::world_direction(CapturedSpace space, const Real3& n) const {
  if (space == CapturedSpace::world) return n;
  const double y = space == CapturedSpace::view_y_down_z_away ? -n[1] : n[1];
  const double z = space == CapturedSpace::view ? -n[2] : n[2];
  return plus(plus(plus({}, right_, n[0]), up_, y), forward_, z);
}

Real3 CameraFrame::world_position(CapturedSpace space, const Real3& p) const {
  return space == CapturedSpace::world ? p : plus(world_direction(space, p), eye_, 1);
}

/// Normalized device coordinates of a pixel's centre.
std::array<double, 2> CameraFrame::ndc(int x, int y) const {
  const double nx = (x + 0.5 - viewport_.x) * 2 / viewport_.width - 1;
  const double ny = (height_ - 1 - y + 0.5 - viewport_.y) * 2 / viewport_.height - 1;
  return {nx, geometry_.clip_origin == ClipOrigin::upper_left ? -ny : ny};
}

/// Intersects three planes: of the pixel's column, of the pixel's row, and the one at this depth across the camera's
/// axis.
Real3 CameraFrame::at_linear(int x, int y, double depth) const {
  const std::array<double, 2> at = ndc(x, y);
  const double w = w_per_unit_ > 0 ? w_per_unit_ * depth : matrix_[15];
  const Real3 rows[3] = {clip_row(0), clip_row(1), forward_};
  const double right[3] = {at[0] * w - matrix_[12], at[1] * w - matrix_[13], dot3(forward_, eye_) + depth};
  const Real3 bc = crossed(rows[1], rows[2]), ca = crossed(rows[2], rows[0]), ab = crossed(rows[0], rows[1]);
  const double determinant = dot3(rows[0], bc);
  Real3 point{};
  for (size_t k = 0; k < 3; ++k) point[k] = (right[0] * bc[k] + right[1] * ca[k] + right[2] * ab[k]) / determinant;
  return point;
}

Real3 CameraFrame::at_distance(int x, int y, double distance) const {
  if (w_per_unit_ == 0) return at_linear(x, y, distance);
  return plus(eye_, unit3(plus(at_linear(x, y, 1), eye_, -1)), distance);
}

Real3 CameraFrame::at_window(int x, int y, double depth) const {
  const double near = double(geometry_.depth_near), far = double(geometry_.depth_far);
  const bool zero_to_one = geometry_.clip_depth == ClipDepth::zero_to_one;
  const double z = zero_to_one ? (depth - near) / (far - near) : (2 * depth - near - far) / (far - near);
  const std::array<double, 2> at = ndc(x, y);
  const oracle::Vector4 p = oracle::transformed(inverse_, {at[0], at[1], z, 1});
  return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

double CameraFrame::window_depth(const Real3& point) const {
  const double near = double(geometry_.depth_near), far = double(geometry_.depth_far);
  const double z = clip(2, point) / clip(3, point);
  return geometry_.clip_depth == ClipDepth::zero_to_one ? near + (far - near) * z
                                                        : (near + far) / 2 + (far - near) / 2 * z;
}

}  // namespace trueshade
