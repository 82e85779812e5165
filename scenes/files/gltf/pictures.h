#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files/gltf/buffers.h"

namespace trueshade::gltf {

/// A document's pictures as textures of a scene. Those that are asked for are decoded together, by all cores. Borrows
/// all it is given.
class Pictures {
 public:
  Pictures(Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits, const ImageDecoder& decode,
           Scene& scene)
      : buffers_(buffers),
        document_(buffers.document()),
        folder_(folder),
        limits_(limits),
        decode_(decode),
        scene_(scene) {}

  /// Index of a picture in Scene::textures, where it has no texels before decode_all().
  int32_t texture(uint32_t image, TextureFormat format, bool has_levels);

  /// Error(bad_input) with the JSON pointer for a picture that is neither PNG nor JPEG, is missing or broken;
  /// Error(limit) for pictures and their levels over limits.texture_bytes. Picture files that no
  /// material uses are only looked for, so that a missing one is an error. The error is the same however many cores there are.
  void decode_all();

 private:
  struct Wanted {
    uint32_t image;
    bool has_levels;
  };
  struct Task;

  void decode_some(size_t first, size_t count);
  void take(Image image, size_t index);
  Bytes content(uint32_t image, std::span<const uint8_t>& view) const;
  void check_file(uint32_t image) const;
  std::string place_of(uint32_t image) const;

  Buffers& buffers_;
  const Document& document_;
  const SceneFolder& folder_;
  const SceneLimits& limits_;
  const ImageDecoder& decode_;
  Scene& scene_;
  uint64_t bytes_ = 0;                                              ///< decoded, with levels
  std::vector<Wanted> wanted_;                                      ///< one a texture of the scene
  std::map<std::pair<uint32_t, TextureFormat>, int32_t> textures_;  ///< by image and format
};

}  // namespace trueshade::gltf
