#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "scenes/scene.h"

namespace trueshade {

/// The bytes of a PNG that holds an rgba8 image's codes as they are. Made by who links an image library; scenes does
/// not.
using PictureEncoder = std::function<std::vector<uint8_t>(const Image& image)>;

struct GlbFile {
  std::vector<uint8_t> bytes;
  std::vector<std::string> notes;  ///< what other programs, or all, do not find in it: full sentences without full stop
};

/// A scene as a GLB file. Loaded by load_scene() it gives the same scene: meshes, materials, texels, instances, lights,
/// camera, timeline and pipeline to the bit, so that frames and scene_hash() are equal. For other programs it says in
/// glTF what glTF can say; docs/export.md. Meshes that set_time() poses are written as they stand, and the scene then
/// has no timeline. Error(limit) for a file over what is read.
GlbFile glb_of_scene(const Scene& scene, const PictureEncoder& encode);

}  // namespace trueshade
