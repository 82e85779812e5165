#pragma once
#include <span>

#include "tests/judge/mutants/glass_mutants.h"
#include "judge/bounds/profile.h"
#include "tests/judge/tries.h"

namespace trueshade::testing {

/// What draws a scene, and the same while the target is looked at after each light and after each transparent object.
/// A sink may be empty.
struct GlassRenderer {
  oracle::Renderer draw;
  std::function<oracle::Capture(const Scene&, const Pipeline&, const oracle::StepSink& light,
                                const oracle::StepSink& object)>
      watched;
};

/// Every way of `glass_mutants()` on built-in scenes under glass, by every strategy in both modes: right pictures must
/// pass under each profile, judged object by object and by the last image alone; wrong ones be rejected on two scenes
/// by each profile. A wrong one is judged object by object too where the last image does not reject it, and under
/// deferred-loop, and must be rejected so. Prints the counts.
void try_glass_mutants(std::span<const oracle::Profile> profiles, const GlassRenderer& renderer, Tries tries);

}  // namespace trueshade::testing
