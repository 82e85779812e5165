#pragma once
#include <optional>
#include <string>

#include "scenes/camera.h"
#include "scenes/files/gltf/document.h"
#include "scenes/light.h"

namespace trueshade::gltf {

/// A light of KHR_lights_punctual at the origin, along -z. Error(bad_input) for a type that the extension does not
/// define.
Light light_of(const Document& document, uint32_t index);

/// A camera's lens: near, far and the vertical angle, which is kept whatever the picture's shape is; an absent zfar is
/// 1e18. `clip_from_view` is set for an orthographic camera: it shows xmag and ymag to each side.
struct Lens {
  Camera camera;
  std::optional<Matrix4> clip_from_view;
};
Lens lens_of(const Document& document, uint32_t index);

}  // namespace trueshade::gltf
