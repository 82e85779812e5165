#pragma once
#include <string>

#include "cli/options.h"
#include "core/image_files/image_io.h"
#include "scenes/scene.h"

namespace trueshade {

/// How files of a picture of that pipeline are written. Views, and pictures that the post chain has encoded, hold
/// display codes already.
ImageFileOptions file_options(const RenderOptions& options, const Pipeline& pipeline, const Scene& scene);

/// Says that PNGs of a float target are sRGB-encoded, where no option asked for an encoding. Empty where that is not
/// so, and of a model whose target no option chose: docs/color.md says it of all of them.
std::string encoding_note(const RenderOptions& options, const Pipeline& pipeline, const Scene& scene);

}  // namespace trueshade
