#pragma once
#include <cstring>

#include "scenes/files/gltf/writing/glb_scene.h"
#include "scenes/files/gltf_scene.h"
#include "tests/catch.hpp"

namespace trueshade {

/// Pictures as the tests write them: what PNG files begin with, the size, and the codes as they are.
inline std::vector<uint8_t> stored_picture(const Image& image) {
  std::vector<uint8_t> bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  for (const int side : {image.width, image.height})
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(uint8_t(side >> shift));
  bytes.insert(bytes.end(), image.texels.begin(), image.texels.end());
  return bytes;
}

inline Image loaded_picture(std::span<const uint8_t> content, const std::string&, uint64_t) {
  int sides[2];
  REQUIRE(content.size() >= 16);
  std::memcpy(sides, content.data() + 8, sizeof sides);
  Image image(sides[0], sides[1], Format::rgba8);
  REQUIRE(content.size() == 16 + image.texels.size());
  std::memcpy(image.texels.data(), content.data() + 16, image.texels.size());
  return image;
}

/// A scene written and loaded again.
inline Scene written_and_loaded(const Scene& scene) {
  const GlbFile file = glb_of_scene(scene, stored_picture);
  Scene loaded = scene_from_gltf(file.bytes, "written.glb", {}, loaded_picture);
  validate(loaded);
  return loaded;
}

}  // namespace trueshade
