#pragma once
#include <span>

#include "tests/judge/mutants/blend_mutants.h"
#include "judge/bounds/profile.h"

namespace trueshade::testing {

/// Every way of `blend_mutants()` drawn wrong, by both strategies that draw lights one by one, on three built-in scenes
/// of few lights that reach far: right steps must pass under each profile, wrong ones must not, and each way must be
/// rejected on two scenes. Prints the counts.
void try_blend_mutants(std::span<const oracle::Profile> profiles, const oracle::Renderer& render,
                       const oracle::StepRenderer& step);

}  // namespace trueshade::testing
