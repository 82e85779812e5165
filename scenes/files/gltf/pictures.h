#pragma once
#include <functional>
#include <map>
#include <set>
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
           Faults& faults, Scene& scene)
      : buffers_(buffers),
        document_(buffers.document()),
        folder_(folder),
        limits_(limits),
        decode_(decode),
        faults_(faults),
        scene_(scene) {}

  /// Index of a picture in Scene::textures, where it has no texels before decode_all(). Images that name the same view
  /// or the same URI are one picture.
  int32_t texture(uint32_t image, TextureFormat format, bool has_levels);

  /// Before any picture is decoded: Error(bad_input) with the JSON pointer for a picture that is neither PNG nor JPEG,
  /// is missing, or whose header is broken. Picture files that no material uses are only looked for, so that a missing
  /// one is an error. Adds a note to the scene where a media type is not what the picture is.
  void check();

  /// Decodes what was checked, while one of the cores does `meanwhile`, which neither asks for another picture nor
  /// touches the scene's textures. Error(bad_input) for a picture that is broken; Error(limit) for pictures and their
  /// levels over limits.texture_bytes. The error is the same however many cores there are: that of `meanwhile`, if it
  /// throws, else that of the first picture. No picture is begun after `meanwhile` has failed.
  void decode_all(const std::function<void()>& meanwhile);

  /// Of each texture of the scene, whether its picture was passed over as a fault, so that it has no texels.
  std::vector<bool> lost() const;

 private:
  struct Wanted {
    uint32_t image;
    bool has_levels;
  };
  struct Content;
  struct Task;

  uint32_t first_with_content_of(uint32_t image);
  std::string_view check_content(uint32_t image) const;
  void check_media_types(const std::map<uint32_t, std::string_view>& kinds);
  void decode_some(size_t first, size_t count, const std::function<void()>& meanwhile);
  void take(Image image, size_t index);
  Content content(uint32_t image) const;
  void check_file(uint32_t image) const;
  std::string place_of(uint32_t image) const;
  void lose(uint32_t image, const Error& error);

  Buffers& buffers_;
  const Document& document_;
  const SceneFolder& folder_;
  const SceneLimits& limits_;
  const ImageDecoder& decode_;
  Faults& faults_;
  Scene& scene_;
  uint64_t bytes_ = 0;                                                ///< decoded, with levels
  std::vector<Wanted> wanted_;                                        ///< one a texture of the scene
  std::map<std::pair<uint32_t, TextureFormat>, int32_t> textures_;    ///< by image and format
  std::map<std::pair<uint32_t, std::string_view>, uint32_t> firsts_;  ///< images that are asked for, by view and URI
  std::map<uint32_t, uint32_t> first_of_;                             ///< images asked for, to those of `firsts_`
  std::set<uint32_t> lost_;                                           ///< images
};

}  // namespace trueshade::gltf
