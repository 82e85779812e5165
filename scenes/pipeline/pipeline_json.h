#pragma once
#include <span>

#include "scenes/json/json_value.h"
#include "scenes/pipeline/pipeline.h"

// Inside of pipeline_json.cpp that the scene reader and the tests share.
namespace trueshade {

/// The keys of every object of a pipeline's text, the root first.
std::span<const json::ObjectKeys> pipeline_object_keys();

/// pipeline_from_json() of a value inside another text, such as a scene's "pipeline".
Pipeline pipeline_from_node(const json::Node& node, const Pipeline& base);

}  // namespace trueshade
