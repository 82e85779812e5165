#pragma once
#include "bench/contest.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

/// Frames of a sequence, and each of them drawn again.
struct MovingTime {
  Timing next;   ///< of frames that are drawn first, with what moves the scene
  Timing again;  ///< of the same frames, drawn once more at once
  double ratio() const { return next.median() / again.median(); }
};

/// Draws a sequence in which everything moves (bench/moving_scene.h), every frame twice. `scene` is the one that
/// `prepared` was made of; it comes back as it was. Throws std::runtime_error where a frame differs from itself drawn
/// again, or from one that nothing was drawn before.
MovingTime moving_time(Scene& scene, const PreparedScene& prepared, const Pipeline& pipeline,
                       const Execution& execution);

}  // namespace trueshade
