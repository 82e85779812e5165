// What goes wrong as a G-buffer is packed and read: the picture is lit from the plane as it is.
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;

Capture normals_in_8_bits(const Subject& s) {
  return stored_with(s, "normal", [](const glm::dvec3& n, int, int, const Capture&) {
    return glm::round((glm::normalize(n) * 0.5 + 0.5) * 255.0) / 255.0 * 2.0 - 1.0;
  });
}

/// Two components are stored, and the third is the root of what is left of 1, never negative.
Capture normal_z_rebuilt(const Subject& s) {
  return stored_with(s, "normal", [](const glm::dvec3& n, int, int, const Capture&) {
    const glm::dvec3 u = glm::normalize(n);
    return glm::dvec3(u.x, u.y, std::sqrt(std::max(0.0, 1.0 - u.x * u.x - u.y * u.y)));
  });
}

Capture positions_from_16_bits(const Subject& s) {
  const Camera& camera = s.scene.camera;
  const double near = camera.near, far = camera.far;
  const auto along_axis = [=](double depth) { return near * far / (far - depth * (far - near)); };
  return stored_with(s, "position", [&](const glm::dvec3& p, int x, int y, const Capture& right) {
    const double depth = right.plane("depth")->value(x, y, 0);
    const double stored = std::round(depth * 65535) / 65535;
    const glm::dvec3 eye(camera.eye);
    return eye + (p - eye) * (along_axis(stored) / along_axis(depth));
  });
}

/// Positions are rebuilt at the upper left corners of pixels.
Capture positions_at_corners(const Subject& s) {
  const Camera& camera = s.scene.camera;
  const glm::dvec3 eye(camera.eye), ahead = glm::normalize(glm::dvec3(camera.target) - eye);
  const glm::dvec3 right_hand = glm::normalize(glm::cross(ahead, glm::dvec3(camera.up)));
  const glm::dvec3 up = glm::cross(right_hand, ahead);
  const double pixel = 2 * std::tan(double(camera.fov_y_rad) / 2) / s.pipeline.height;
  return stored_with(s, "position", [=](const glm::dvec3& p, int, int, const Capture&) {
    return p + 0.5 * pixel * glm::dot(p - eye, ahead) * (up - right_hand);
  });
}

Capture albedo_565(const Subject& s) {
  return stored_with(s, "albedo", [](const glm::dvec3& a, int, int, const Capture&) {
    const glm::dvec3 largest(31, 63, 31);
    return glm::round(a * largest) / largest;
  });
}

}  // namespace

std::vector<UnseenFault> unseen_faults_of_planes() {
  const std::string_view all = "city cornell lecture";
  return {
      {"normals-in-8-bits", "normals are stored in unorm codes of 8 bits", "normal-bits", all, normals_in_8_bits},
      {"normal-z-rebuilt", "a normal's Z is the root of what X and Y leave", "- normal-z-turned", all,
       normal_z_rebuilt},
      {"positions-from-16-bits", "positions are rebuilt from depths of 16 bits", "- depth-bits depth-format", all,
       positions_from_16_bits},
      {"positions-at-corners", "positions are rebuilt at the corners of pixels", "- half-pixel", all,
       positions_at_corners},
      {"albedo-565", "the albedo has 5, 6 and 5 bits", "-", all, albedo_565},
  };
}

}  // namespace trueshade::testing
