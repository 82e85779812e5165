#pragma once
// Statistical tests of a whole image: an image each pixel of which is legal may still be one that no honest rounding
// makes (docs/gl_rules.md section 9).
#include <string>
#include <vector>

#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// A number that was counted in an image, against the most that chance is expected to make of it.
struct AggregateTest {
  std::string name;
  double observed = 0, low = 0, high = 0;  ///< expected between these
  double chance = 1;    ///< a bound on how likely an implementation that follows the rule makes such a number; in any
                        ///< of all regions
  std::string where{};  ///< of a region: `tile of 16x16 at 32,48`
  /// Whether the bound on the likelihood is at least this one.
  bool passes(double least_chance) const { return chance >= least_chance; }
};

inline constexpr size_t kAggregateTests = 9;  ///< a stage

/// A bound on the likelihood that a sum of independent numbers between 0 and 1, of which `mean` is expected, is at
/// least `observed`: Bernstein's bound exp(-t^2 / (2 (mean + t / 3))) with t = observed - mean; 1 where t is not above
/// 0.
double chance_of_at_least(double observed, double mean);

/// Makes the nine tests of one stage of a judgement; the caller compares their `chance` with a limit. A choice is a
/// pixel, or a store, that rounding errors let go one of two ways, with a predicted chance. Pixels of one triangle, and
/// stores of equal values, are one choice, which counts for the share of its pixels that went the other way; so choices
/// are independent. Predictions take errors to be spread evenly over their bounds. Systematic errors reach twice as
/// many choices at most, so twice the predicted number is what is expected at most.
///   ruled out          stores that the likely rule rules out; one in 2^20 is let pass
///   equal values apart neighbouring pixels that stored one value as different codes, although the rule leaves one
///   crossed stores     stores that no nondecreasing conversion to codes makes; one in 2^20 is let pass
///   second neighbours  stores that took another than the nominal neighbour, where the rule leaves a choice
///   store bias         their sum with signs, up or down (a drift such as truncation shows here)
///   store clusters     neighbouring pixels of unequal values that both took another than the nominal neighbour
///   other surfaces     pixels that show another than the nominal surface or branch of the shader
///   stores of a region, surfaces of a region
///                      tiles of 8, 16, 32 and 64 pixels, and halves of the image: choices that went the other way, of
///                      stores or of surfaces, against the share that they have elsewhere
std::vector<AggregateTest> aggregate_tests(const StageVerdict& verdict);

/// The test with the smallest chance. `tests` is not empty.
const AggregateTest& least_likely(const std::vector<AggregateTest>& tests);

}  // namespace trueshade::oracle
