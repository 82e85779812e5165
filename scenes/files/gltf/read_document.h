#pragma once
#include <string>

#include "scenes/files/gltf/document.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

/// Reads a container's JSON. All of it is checked, whether a scene uses it or not: types, ranges, indices, and that
/// views lie in their buffers and accessors in their views. Values of lists that extensions may add to (a light's type,
/// an alpha mode) are checked where they are used. Error(bad_input) with a JSON pointer, also for a required extension
/// that is not implemented or not drawn, with its name. Error(limit) for too many nodes.
Document read_document(const Container& container, const std::string& file, const SceneLimits& limits);

}  // namespace trueshade::gltf
