#pragma once
#include <random>

#include "core/blend_state.h"

namespace trueshade::testing {

using Random = std::mt19937_64;

inline BlendTerm random_term(Random& random) {
  return {BlendEquation(random() % kBlendEquations), BlendFactor(random() % kBlendFactors),
          BlendFactor(random() % kBlendFactors)};
}

}  // namespace trueshade::testing
