#pragma once
#include <set>
#include <span>
#include <string>

#include "tests/judge/mutants/mutants.h"
#include "judge/bounds/profile.h"
#include "tests/judge/tries.h"

namespace trueshade::testing {

/// What became of the tries of one wrong renderer: a try is a picture that differs from the right one, judged by one
/// profile.
struct MutantScore {
  int tries = 0, rejected = 0;
  std::set<std::string> scenes;         ///< that any profile rejects it on
  std::set<std::string> scenes_by_any;  ///< the same by `unknown`
  uint64_t pixels = 0;
};

/// Every wrong renderer of `mutants()` on seven scenes, where `renderer` draws. Each try must be rejected, or its
/// picture shown to be legal without the judge (legal_by_formula.h); each renderer be rejected on two scenes at least,
/// by any GPU's rules too where these leave no latitude. Prints the counts.
///   presets: how many of stated_presets() are tried on every scene; on cornell all are
///   same: those that change no picture here
///   inside: those whose pictures are all legal here, beside those of Latitude::always_legal
///   tries: half leaves out none of those that a profile's latitude may make legal
void try_mutants(std::span<const oracle::Profile> profiles, const oracle::Renderer& renderer, size_t presets,
                 std::span<const std::string_view> same, std::span<const std::string_view> inside, Tries tries);

}  // namespace trueshade::testing
