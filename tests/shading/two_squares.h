#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene.h"
#include "tests/shading/square_mesh.h"

// What tests of planes and views draw, and how they read what was drawn.
namespace trueshade::testing {

inline Pipeline pipeline_of(std::string_view preset, int width, int height) {
  Pipeline p = *preset_pipeline(preset);
  p.width = width;
  p.height = height;
  return p;
}

template <typename Value>
Value at(const Image& image, int x, int y, int channel = 0) {
  Value value;
  std::memcpy(&value, image.texel(x, y) + sizeof value * size_t(channel), sizeof value);
  return value;
}

inline std::array<int, 3> rgb(const Image& image, int x, int y) {
  const uint8_t* texel = image.texel(x, y);
  return {texel[0], texel[1], texel[2]};
}

/// Two squares across the view of a camera at z = 4 that looks down -z: one of side 2 at z = 0, red, and one of side 4
/// at z = -2, green, both facing the camera; no lights. Seen under 90 degrees they fill pixels whose |x| from the
/// centre, in half heights, is below 1/4 and 1/3.
inline Scene two_squares() {
  Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials.resize(2);
  scene.materials[0].base_color = {1.0f, 0.0f, 0.0f, 1.0f};
  scene.materials[1].base_color = {0.0f, 1.0f, 0.0f, 1.0f};
  glm::mat4x3 near(2.0f), far(4.0f);
  near[3] = {0.0f, 0.0f, 0.0f};
  far[3] = {0.0f, 0.0f, -2.0f};
  scene.instances.resize(2);
  scene.instances[0].world_from_object = near;
  scene.instances[1].world_from_object = far;
  scene.instances[1].material = 1;
  scene.camera.eye = {0.0f, 0.0f, 4.0f};
  scene.camera.fov_y_rad = 1.57079633f;
  return scene;
}

inline Light bulb(const glm::vec3& place, float range) {
  Light light;
  light.position = place;
  light.range = range;
  return light;
}

}  // namespace trueshade::testing
