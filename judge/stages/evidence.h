#pragma once
// Which known way of rounding a stage of an image follows, and whether it follows any.
#include <functional>
#include <vector>

#include "judge/stages/aggregate.h"

namespace trueshade::oracle {

/// What the statistical tests of the whole image say of one stage.
struct Evidence {
  std::vector<AggregateTest> tests;  ///< by the rounding rule `rule`
  StoreRule rule;         ///< the first that the image follows, of those that the profile allows; else the likeliest
  bool as_stated = true;  ///< `rule` is the one that profile and pipeline state
  bool against = false;   ///< the image follows no known rule

  /// The test whose chance is the smallest.
  const AggregateTest& least_likely() const { return oracle::least_likely(tests); }
};

/// Tests a stage by the rounding rule that is stated. If a test fails, tries the other known rules that the profile
/// allows, until the image follows one: nearest codes, within 0.6 (D3D11.3), llvmpipe's with the estimates of AMD's and
/// of Intel's CPUs, sums kept in floats (softpipe); halves toward zero and to nearest. A stage with violations is not
/// tried again: its pixels convict it.
///   stated:       the stage, judged by `profile`
///   judge:        judges the same stage by another profile; called once for each other rule that is tried
///   least_chance: a test with a smaller chance fails
Evidence evidence_of(const StageVerdict& stated, const std::function<StageVerdict(const Profile&)>& judge,
                     const Profile& profile, double least_chance);

/// The N of "one in N" for a chance: `1000`, or from 10^4 on a power of ten with its exponent rounded down, `10^12`. Of
/// a chance that is not above 0, `more than 10^300`.
std::string one_in(double chance);

}  // namespace trueshade::oracle
