#pragma once
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// What of a pipeline the brightness of lights of ours depends on.
struct LightFit {
  bool spreads = false;      ///< light spreads by the inverse square
  bool divides_pi = false;   ///< diffuse light is divided by pi
  bool operator==(const LightFit&) const = default;
};
LightFit fit_of(const Pipeline& pipeline);

/// Makes lights of ours (scenes/lights_of_ours.h) as bright under a pipeline as under those that their scene was made
/// for. Where light spreads by the inverse square, a lamp has more the farther away it is, so that a model in
/// millimetres and one in kilometres look the same. Models that ship spread light so, and divide diffuse light by pi,
/// which presets do not: a lamp has pi times as much there. What a user's program does is not known: it gets what the
/// pipeline's model does. Other lights stay.
void fit_lights_of_ours(Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
