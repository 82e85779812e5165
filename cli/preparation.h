#pragma once
#include <string>

#include "cli/options.h"
#include "scenes/scene.h"

namespace trueshade {

/// Checks what can be known of the pipeline before a scene is loaded, which may take long: all of it for a built-in
/// scene, which has no pipeline of its own, and the syntax of the pipeline file for any other. Throws as pipeline_of().
void check_pipeline(const PipelineOptions& options);

/// The pipeline of all layers, each over the one before: preset, scene file, pipeline file, options. Valid.
Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene);

}  // namespace trueshade
