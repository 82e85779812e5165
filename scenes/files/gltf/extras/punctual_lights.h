#pragma once
#include <string>

#include "scenes/files/gltf/document.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

/// Candela, or lux, that light a surface about as the scene's light does: for falloffs that end, equal at half the
/// range to the line 1 - d / range, otherwise equal far away to 1 / (k2 d^2).
double photometric_intensity(const Light& light, bool photometric);

/// A note where the lights that stand in the document for other programs are not those that the scene was written with;
/// else nothing. Ambient lights are not among the former. Positions are compared where no light moves.
std::string note_of_lights(const Document& document, const Scene& scene);

}  // namespace trueshade::gltf
