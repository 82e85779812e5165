#pragma once
#include <string>

#include "cli/options.h"

namespace trueshade {

/// A word as a shell reads it back.
std::string for_shell(const std::string& word);

/// The command that explains a pixel {x},{y} of what a command drew or judged: its scene and its options of the
/// pipeline, at the size and the time that it had, seen with `camera`. `against`: a picture of the same frame, or
/// empty.
std::string explain_command(const PipelineOptions& options, const CameraChanges& camera, const Pipeline& pipeline,
                            double time, const std::string& against);

}  // namespace trueshade
