#pragma once
#include <span>
#include <string>
#include <string_view>

#include "scenes/files/reference_json.h"
#include "scenes/json/json_value.h"
#include "scenes/scene.h"

namespace trueshade {

/// The keys of every object of a scene's text, the root first; those of its "pipeline" aside.
std::span<const json::ObjectKeys> scene_object_keys();

/// Scene of a JSON text (scenes/schemas/scene.schema.json). Geometry and image files are read from the folder of
/// `path`, geometry once each, images by `decode`; a scene that the text refers to by `load`, without which it is
/// refused. Not validated. Error(bad_input) with JSON pointer, line or byte; Error(limit), Error(io) for the files.
Scene scene_from_json(std::string_view text, const std::string& path, const SceneLimits& limits,
                      const ImageDecoder& decode = {}, const SceneLoader& load = {});

}  // namespace trueshade
