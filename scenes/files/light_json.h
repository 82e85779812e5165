#pragma once
#include <string>
#include <vector>

#include "scenes/json/json_value.h"
#include "scenes/scene.h"

namespace trueshade {

/// The keys of lights, their steps and the generators of lights.
std::vector<json::ObjectKeys> light_json_keys();

/// Appends the lights of a scene's text, and what moves of them. Buffers of lights are read from the folder of `path`,
/// pictures by `decode`. Error(limit) before more are made than `limits` allow.
void read_lights(const json::Node& list, Scene& scene, const std::string& path, const SceneLimits& limits,
                 const ImageDecoder& decode);

}  // namespace trueshade
