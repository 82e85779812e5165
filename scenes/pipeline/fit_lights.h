#pragma once
#include "scenes/pipeline/light_model.h"
#include "scenes/scene.h"

namespace trueshade {

/// Makes lights of ours (scenes/lights_of_ours.h) as bright under a light model as under those that their scene was
/// made for: where light spreads by the inverse square, a lamp has more the farther away it is, so that a model in
/// millimetres and one in kilometres look the same. Other lights stay.
void fit_lights_of_ours(Scene& scene, const LightModel& model);

}  // namespace trueshade
