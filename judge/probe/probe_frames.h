#pragma once
// Frames that tell what a driver does where OpenGL lets it choose.
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A frame that the probed driver is asked to draw.
struct ProbePlan {
  std::string name;  ///< `shards into rgba16f`
  Scene scene;
  Pipeline pipeline;
};

/// Makes the frames that a driver is probed with (`seed` 1), or frames held out to check the result (other seeds): of
/// the same kinds, with other triangles, texels and lights. They have 96x72 pixels each.
std::vector<ProbePlan> probe_plans(uint64_t seed);

}  // namespace trueshade::oracle
