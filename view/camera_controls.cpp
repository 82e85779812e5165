#include "view/camera_controls.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/fp_env.h"

namespace trueshade::viewer {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSteepest = kPi / 2.0 - kPi / 180.0;  // radians above or below the horizon
constexpr double kNarrowest = kPi / 1800.0;            // field of view, radians
constexpr double kSecondsToSpeed = 0.05;               // in which flight takes up 63 % of a new speed

/// Any unit vector at right angles to a unit vector.
glm::dvec3 beside(const glm::dvec3& v) {
  const glm::dvec3 axis = std::fabs(v.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
  return glm::normalize(glm::cross(v, axis));
}

}  // namespace

Camera camera_with_lens(const Camera& camera, double reach) {
  const FpScope fp;
  if (!camera.clip_from_world) return camera;
  const std::array<float, 16>& m = *camera.clip_from_world;
  const glm::dvec3 forward = -glm::dvec3(view_axis(camera));
  const glm::dvec3 upward(m[1], m[5], m[9]), deep(m[3], m[7], m[11]);
  Camera out;
  out.eye = camera.eye;
  out.target = glm::vec3(glm::dvec3(camera.eye) + forward * reach);
  const glm::dvec3 level = upward - forward * glm::dot(upward, forward);
  out.up = glm::vec3(glm::length(level) > 0.0 ? glm::normalize(level) : beside(forward));
  const double per_depth = glm::length(level) / glm::length(deep);  // 1 / tan(half the angle); not finite if parallel
  out.fov_y_rad = std::isfinite(per_depth) && per_depth > 0.0 ? float(2.0 * std::atan(1.0 / per_depth)) : 0.8f;
  out.near = float(reach / 1000.0);
  out.far = float(reach * 20.0);
  return out;
}

CameraControls::CameraControls(const Camera& from, double reach) : lens_(camera_with_lens(from, reach)), reach_(reach) {
  const FpScope fp;
  eye_ = lens_.eye;
  const glm::dvec3 view = glm::dvec3(lens_.target) - eye_;
  distance_ = glm::length(view);
  up_ = glm::normalize(glm::dvec3(lens_.up));
  side_ = beside(up_);
  ahead_ = glm::cross(up_, side_);
  aim(view / distance_);
  speed_ = reach / 4.0;
}

void CameraControls::aim(const glm::dvec3& direction) {
  pitch_ = std::clamp(std::asin(std::clamp(glm::dot(direction, up_), -1.0, 1.0)), -kSteepest, kSteepest);
  yaw_ = std::atan2(glm::dot(direction, side_), glm::dot(direction, ahead_));
}

glm::dvec3 CameraControls::forward() const {
  return (ahead_ * std::cos(yaw_) + side_ * std::sin(yaw_)) * std::cos(pitch_) + up_ * std::sin(pitch_);
}

void CameraControls::turn(double right, double up) {
  yaw_ = std::remainder(yaw_ + right, 2.0 * kPi);
  pitch_ = std::clamp(pitch_ + up, -kSteepest, kSteepest);
}

void CameraControls::step(const CameraInput& input, double seconds) {
  const FpScope fp;
  turn(input.turn.x, input.turn.y);
  if (input.orbit != glm::dvec2(0.0) || input.nearer != 0.0) {
    const glm::dvec3 pivot = eye_ + forward() * distance_;
    turn(-input.orbit.x, -input.orbit.y);
    distance_ = std::max(distance_ * std::pow(0.9, input.nearer), 2.0 * double(lens_.near));
    eye_ = pivot - forward() * distance_;
  }
  const glm::dvec3 wanted = input.fly * (speed_ * input.pace);
  velocity_ = wanted + (velocity_ - wanted) * std::exp(-seconds / kSecondsToSpeed);
  if (input.fly == glm::dvec3(0.0) && glm::length(velocity_) < 1e-3 * speed_) velocity_ = glm::dvec3(0.0);
  const glm::dvec3 right = glm::normalize(glm::cross(forward(), up_));
  eye_ += (right * velocity_.x + up_ * velocity_.y + forward() * velocity_.z) * seconds;
}

Camera CameraControls::camera() const {
  const FpScope fp;
  Camera camera = lens_;
  camera.eye = glm::vec3(eye_);
  camera.target = glm::vec3(eye_ + forward() * distance_);
  return camera;
}

void CameraControls::change_speed(double steps) {
  speed_ = std::clamp(speed_ * std::pow(1.2, steps), reach_ * 1e-6, reach_ * 1e3);
}

double CameraControls::field_of_view() const { return double(lens_.fov_x_rad ? *lens_.fov_x_rad : lens_.fov_y_rad); }

void CameraControls::set_field_of_view(double radians) {
  radians = std::clamp(radians, kNarrowest, kPi - kNarrowest);
  if (lens_.fov_x_rad)
    lens_.fov_x_rad = float(radians);
  else
    lens_.fov_y_rad = float(radians);
}

void CameraControls::set_pivot(const glm::dvec3& point) {
  const FpScope fp;
  const glm::dvec3 view = point - eye_;
  const double distance = glm::length(view);
  if (!(distance > 0.0) || !std::isfinite(distance)) return;
  distance_ = distance;
  aim(view / distance);
}

}  // namespace trueshade::viewer
