#pragma once
// Tests of a whole image on top of the legal sets of its pixels (docs/gl_rules.md section 9): an image each
// pixel of which is legal may still be one that no honest rounding makes.
#include <string>
#include <vector>

#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// What was seen against the most that chance is expected to make.
struct AggregateTest {
  std::string name;
  double observed = 0, low = 0, high = 0;  ///< expected between these
  double chance = 1;    ///< at most so likely is it, of an implementation that follows the rule; all regions counted
  std::string where{};  ///< of a region: `tile of 16x16 at 32,48`
  /// Whether what was seen is at least so likely.
  bool passes(double least_chance) const { return chance >= least_chance; }
};

inline constexpr size_t kAggregateTests = 9;  ///< a stage

/// A bound on the likelihood that a sum of independent numbers between 0 and 1, of which `mean` is expected, is at
/// least `observed`: Bernstein's bound exp(-t^2 / (2 (mean + t / 3))) with t = observed - mean.
double chance_of_at_least(double observed, double mean);

/// The tests of a stage. Pixels of one triangle, and stores of equal values, are one choice, which counts for the share
/// of its pixels that went the other way: so choices are independent. A prediction spreads errors evenly over their
/// bounds; errors that are systematic reach twice as many choices at most, and that is what is expected at most.
///   ruled out          stores that the likely rule rules out; one in 2^20 is let pass
///   equal values apart stores of one value, in pixels beside each other, of which the rule can make one code alone
///   crossed stores     stores that no nondecreasing conversion to codes makes; one in 2^20 is let pass
///   second neighbours  stores that took another than the nominal neighbour, where the rule leaves a choice
///   store bias         their signed sum (a drift such as truncation shows here)
///   store clusters     neighbouring pixels that both took a second one, of unequal values
///   other surfaces     pixels that show another than the nominal surface or branch
///   a region           tiles of 8, 16, 32 and 64 pixels, and halves of the image: choices that went the other way, of
///                      stores or of surfaces, against the share that they have elsewhere
std::vector<AggregateTest> aggregate_tests(const StageVerdict& verdict);

/// The test with the smallest chance; there is at least one.
const AggregateTest& least_likely(const std::vector<AggregateTest>& tests);

}  // namespace trueshade::oracle
