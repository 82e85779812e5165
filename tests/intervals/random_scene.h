#pragma once
// Small scenes and pipelines at random, for images that must be accepted whoever draws them.
#include "scenes/pcg32.h"
#include "scenes/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// A few boxes and balls before the camera, small triangles and large, with lights among them.
Scene random_scene(Pcg32& random);

/// 32 x 24 pixels, any of the light models, target rgba8 or rgba32f.
Pipeline random_pipeline(Pcg32& random);

}  // namespace trueshade::testing
