#pragma once
#include <span>

#include "judge/bounds/profile.h"
#include "tests/judge/mutants/surface_mutants.h"
#include "tests/judge/tries.h"

namespace trueshade::testing {

/// Every way of `surface_mutants()` drawn wrong on built-in scenes of few lights by three strategies: right pictures
/// must pass under each profile, wrong ones be rejected on two scenes by each profile, by `ideal` always. Prints the
/// counts. Unless all are tried, each that many pictures show is tried on every scene by one
/// strategy, and all are on smaller pictures.
void try_surface_mutants(std::span<const oracle::Profile> profiles, const oracle::Renderer& render, Tries tries);

}  // namespace trueshade::testing
