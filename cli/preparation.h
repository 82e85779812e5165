#pragma once
#include <span>
#include <string>

#include "cli/options.h"
#include "scenes/scene.h"

namespace trueshade {

/// Checks what can be known of the pipeline before a scene is loaded, which may take long: all of it for a built-in
/// scene, which has no pipeline of its own, and the syntax of the pipeline file for any other. Throws as pipeline_of().
void check_pipeline(const PipelineOptions& options);

/// load_scene() with the pictures that files name, within the options' limits.
Scene scene_of_options(const std::string& spec, const Limits& limits);

/// Error(limit) where the frame, with what is in memory, is predicted to be over the memory cap.
/// `outputs`: files to be written, which are made in memory.
void check_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                  std::span<const std::string> aovs, std::span<const std::string> outputs);

/// The pipeline of all layers, each over the one before: preset, scene file, pipeline file, options. Valid.
Pipeline pipeline_of(const PipelineOptions& options, const Scene& scene);

}  // namespace trueshade
