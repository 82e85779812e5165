#pragma once
#include "scenes/scene.h"

namespace trueshade {

/// The lights' extents as geometry: a black axis-aligned box of half side `range` about every point and spot light
/// whose range is finite, in light order, seen by the scene's camera. No lights.
Scene light_boxes(const Scene& scene);

/// The edges alone of the same boxes: bars of 1/256 of the box's side, in the light's colour scaled so that its largest
/// channel is 1 (black stays black).
Scene light_box_edges(const Scene& scene);

/// A sphere of 512 triangles, coloured as those edges, at every point and spot light, in light order. No lights.
Scene light_markers(const Scene& scene, float radius);

}  // namespace trueshade
