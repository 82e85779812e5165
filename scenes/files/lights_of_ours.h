#pragma once
#include "scenes/scene.h"

namespace trueshade {

/// Lights a scene whose file has none: a ring of 24 point lights from warm to cold about what is drawn, over a dark
/// background. In a photometric scene they are as bright at the ring's distance as in others.
void add_lights_of_ours(Scene& scene);

}  // namespace trueshade
