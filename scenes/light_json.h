#pragma once
#include <span>

#include "scenes/json_value.h"
#include "scenes/scene.h"

namespace trueshade {

/// The keys of lights, their steps and the generators of lights.
std::span<const json::ObjectKeys> light_json_keys();

/// Appends the lights of a scene's text, and what moves of them. Error(limit) before more are made than `limits` allow.
void read_lights(const json::Node& list, Scene& scene, const SceneLimits& limits);

}  // namespace trueshade
