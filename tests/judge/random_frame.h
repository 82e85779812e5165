#pragma once
// Scenes and pipelines at random over the whole product of states that a driver may be asked for.
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

struct RandomFrame {
  Scene scene;
  Pipeline pipeline;
};

/// What a frame is to have for sure; the rest of its state is drawn at random.
enum class FrameTheme : uint8_t {
  any,
  clamped_depths,  ///< forward-multipass, and a polygon offset that takes depths to an end of their range
  sloped_depths,   ///< a polygon offset by the slope of thin triangles on silhouettes
  glass_in_halves,  ///< glass that is blended into an albedo of rgb16f
  light_program     ///< lit by a light program at random
};

/// random_scene() with more materials, maps, masks, glass, surfaces that coincide and surfaces behind the eye, at 32x24
/// to 64x48 pixels, under any preset, strategy, format, depth state, transparency and blending. The same seed gives the
/// same frame.
RandomFrame random_frame(uint64_t seed, FrameTheme theme = FrameTheme::any);

}  // namespace trueshade::testing
