#pragma once
#include "core/image.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// The pipeline that a frame before the post chain is drawn by: larger by `samples`, viewport included, and without the
/// chain. Error(limit) where what is drawn of it, the picture or a region, is over 65536 pixels a side.
Pipeline pipeline_before_post(const Pipeline& pipeline, const PictureRegion& region = {});

/// Its execution: the region in samples.
Execution execution_before_post(const Pipeline& pipeline, const Execution& execution);

/// The image that the post chain of `pipeline` makes of the target of pipeline_before_post(). `depth` is that frame's
/// depth plane; read where there are light markers. `logarithmic_mean`: of the whole picture, where this is a part of
/// it and tones are mapped; else 0.
Image finished_image(const Scene& scene, const Pipeline& pipeline, const Execution& execution, const Image& target,
                     const Image* depth, double logarithmic_mean = 0.0);

}  // namespace trueshade
