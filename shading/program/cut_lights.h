#pragma once
#include <cstdint>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Lights that the pipeline ends at their range although its program still adds something there.
struct CutLights {
  uint64_t count = 0;
  uint32_t light = 0;  ///< the one that adds most
  float added = 0.0f;  ///< the largest channel of that
};

/// Asks the program of the pipeline at six places just beyond each light's range, of white surfaces that face the
/// light. A light that is not counted may still be cut elsewhere.
CutLights cut_lights(const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
