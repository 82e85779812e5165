#pragma once
#include <span>

#include "oracle/intervals/glass_mutants.h"
#include "oracle/intervals/profile.h"

namespace trueshade::testing {

/// What draws a scene, the same light by light, and the same by transparent object.
struct GlassRenderer {
  oracle::Renderer draw;
  oracle::StepRenderer lights, objects;
};

/// Every way of `glass_mutants()` on built-in scenes under glass, by every strategy in both modes: right pictures must pass
/// under each profile, judged object by object and by the last image alone; wrong ones be rejected on two scenes by each
/// profile. Prints the counts.
void try_glass_mutants(std::span<const oracle::Profile> profiles, const GlassRenderer& renderer);

}  // namespace trueshade::testing
