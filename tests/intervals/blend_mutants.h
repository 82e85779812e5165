#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "oracle/intervals/blend_mutants.h"
#include "oracle/intervals/profile.h"

namespace trueshade::testing {

struct MutantScore {
  int changed = 0, rejected = 0, by_last = 0;  ///< that differ from the right ones; rejected; by the last image alone
  uint64_t pixels = 0;
  std::set<std::string> scenes;                ///< that reject it
};

/// Three built-in scenes of few lights that reach far.
std::vector<Scene> blend_mutant_scenes();

/// Right and wrong steps under each profile: the right ones pass, the wrong ones must not.
void try_blend_mutant(const oracle::BlendMutant& mutant, const Scene& scene, const Pipeline& pipeline,
                      std::span<const oracle::Profile> profiles, const oracle::Renderer& render,
                      const oracle::StepRenderer& step, MutantScore& score);

void print_scores(const std::map<std::string_view, MutantScore>& scores);

}  // namespace trueshade::testing
