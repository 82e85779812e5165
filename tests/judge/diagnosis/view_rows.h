#pragma once
// The rotation of a camera, for plants that take view space for the world.
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

#include "scenes/camera.h"

namespace trueshade::testing {

/// Right, up, towards the viewer: the rows of a camera's matrix, of unit length, or by eye, target and up.
inline std::array<glm::vec3, 3> view_rows(const Camera& camera) {
  const auto dot = [](const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  const auto unit = [&](const glm::vec3& v) { return v * (1 / std::sqrt(dot(v, v))); };
  const auto cross = [](const glm::vec3& a, const glm::vec3& b) {
    return glm::vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  };
  if (camera.clip_from_world) {
    const auto row = [&m = *camera.clip_from_world](size_t r) { return glm::vec3(m[r], m[4 + r], m[8 + r]); };
    const glm::vec3 back = unit(-row(3));
    const auto across = [&](size_t r) { return unit(row(r) - back * dot(row(r), back)); };
    return {across(0), across(1), back};
  }
  const glm::vec3 back = unit(camera.eye - camera.target), right = unit(cross(camera.up, back));
  return {right, cross(back, right), back};
}

}  // namespace trueshade::testing
