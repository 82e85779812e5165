#pragma once
#include "core/image.h"
#include "gl/driver/objects.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// The post chain of `pipeline` over a frame of pipeline_without_post(): its target, and its depth, which the light
/// markers are tested against and write to. The context must be current; state is left as the last pass set it.
Image finished_by_gl(const Scene& scene, const Pipeline& pipeline, int version, const GlTexture& target,
                     const GlTexture& depth);

}  // namespace trueshade::oracle
