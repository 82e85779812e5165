#pragma once
#include "scenes/files/gltf/buffers.h"
#include "scenes/files/gltf/extras/scene_extras.h"

namespace trueshade::gltf {

/// The scene that a document was written from. Errors as of scene_from_gltf().
Scene scene_of_extras(SceneExtras extras, Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits,
                      const ImageDecoder& decode);

}  // namespace trueshade::gltf
