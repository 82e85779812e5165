#pragma once
#include <string>
#include <vector>

#include "cli/frame_text.h"
#include "cli/options.h"

namespace trueshade {

/// Whether `render` draws this picture in bands, straight into its files.
bool renders_in_bands(const RenderOptions& options, const Pipeline& pipeline);

/// Draws a large picture into files that are .png or .exr, with no more memory than --max-memory. Of result.frame the
/// counts are filled, and images that have a size and a format but no texels.
void render_in_bands(const RenderOptions& options, const PreparedScene& scene, const std::vector<std::string>& files,
                     RenderedFrame& result);

}  // namespace trueshade
