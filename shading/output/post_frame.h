#pragma once
#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// The pipeline that a frame before the post chain is drawn by: larger by `samples`, viewport included, and without the
/// chain. Error(limit) for more than 65536 pixels a side.
Pipeline pipeline_before_post(const Pipeline& pipeline);

/// The image that the post chain of `pipeline` makes of the target of pipeline_before_post(). `depth` is that frame's
/// depth plane; read where there are light markers.
Image finished_image(const Scene& scene, const Pipeline& pipeline, const Execution& execution, const Image& target,
                     const Image* depth);

}  // namespace trueshade
