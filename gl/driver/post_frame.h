#pragma once
#include "core/image.h"
#include "gl/driver/objects.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The picture that the pipeline's post chain makes of a frame drawn by pipeline_without_post(). Light markers are
/// tested against the frame's `depth` and write to it. The context must be current; its state stays as the last pass
/// set it.
Image finished_by_gl(const Scene& scene, const Pipeline& pipeline, int version, const GlTexture& target,
                     const GlTexture& depth);

}  // namespace trueshade::oracle
