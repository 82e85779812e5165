#pragma once
#include <string>

#include "cli/options.h"
#include "scenes/scene.h"

namespace trueshade {

/// The pipeline of all layers, each over the one before: preset, scene file, pipeline file, options. Valid.
Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene);

}  // namespace trueshade
