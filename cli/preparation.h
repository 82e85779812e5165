#pragma once
#include <span>
#include <string>

#include "cli/options.h"
#include "scenes/scene.h"

namespace trueshade {

/// The pipeline of all layers, each over the one before: preset, scene file, pipeline file, options. Valid.
Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene);

/// Error(io) where a file cannot be written to its folder, so that hours of work do not end in one that was never
/// there. Writing may fail later for other reasons.
void check_folders(std::span<const std::string> paths);

}  // namespace trueshade
