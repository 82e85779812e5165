#pragma once
// Small scenes and pipelines at random, for images that must be accepted whoever draws them.
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// A few boxes and balls before the camera, small triangles and large, with point, spot and directional lights among
/// them; half of the scenes are textured, and half of these have normal and specular maps; a quarter has transparent
/// materials.
Scene random_scene(Pcg32& random);

/// Gives the boxes and balls of random_scene() tangents, with the other w on their lower halves.
void add_tangents(Scene& scene);

/// 32 x 24 pixels, any falloff, cone and order of terms; target in 8 bits, sRGB, half or float, normals in half or
/// float, depth in 16, 24 or 32 bits, a quarter of them offset. A quarter each: normals in ten bits, specular colours
/// of the materials, lights of mixed extents; transparent surfaces in every mode and several blends.
Pipeline random_pipeline(Pcg32& random);

}  // namespace trueshade::testing
