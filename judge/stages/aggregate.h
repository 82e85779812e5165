#pragma once
// Tests of a whole image on top of the legal sets of its pixels (docs/gl_rules.md section 7, point 4): an image each
// pixel of which is legal may still be one that no honest rounding makes.
#include <string>
#include <vector>

#include "judge/stages/verdict.h"

namespace trueshade::oracle {

/// observed against expected, in standard deviations of what chance does.
struct AggregateTest {
  std::string name;
  double observed = 0, expected = 0, sigma = 1;
  bool one_sided = true;  ///< expectations are upper bounds: errors are taken to fill their whole interval
  bool tested = true;     ///< false: the stage leaves nothing to count
  double deviation() const { return (observed - expected) / sigma; }
  bool passes() const {
    return !tested || (one_sided ? deviation() : deviation() < 0 ? -deviation() : deviation()) <= 6;
  }
};

/// Four tests a stage:
///   other surfaces     pixels that show another than the nominal surface or branch; pixels of one triangle move
///   together,
///                      so sigma^2 = sum over triangles of (sum p)^2 + 1
///   second neighbours  channels stored as another than the nominal neighbour; equal values are one choice, so
///                      sigma^2 = sum over values of (n p)^2 + 1
///   store bias         their signed sum; sigma as before (a drift such as truncation shows here)
///   store clusters     neighbouring pixels that both took a second one, of unequal values: expected sum p_i p_j
/// The last three are not tested where only the last of many blends is known (StageVerdict::stores_apart): what one
/// store took cannot be told from the next one's.
/// The 1 keeps a lone pixel from being six deviations where nothing was expected.
std::vector<AggregateTest> aggregate_tests(const StageVerdict& verdict);

}  // namespace trueshade::oracle
