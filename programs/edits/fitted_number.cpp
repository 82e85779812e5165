#include "programs/edits/fitted_number.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace trueshade::programs {

bool fit_number(ProgramEdit& edit, const EditDistance& distance, Samples samples) {
  constexpr double kGrid[] = {-1,   0,    0.05, 0.1,  0.2,   0.25,  0.3333, 0.5,   0.67, 0.8,
                              0.9,  0.95, 0.98, 0.99, 0.997, 0.999, 1.001,  1.003, 1.01, 1.02,
                              1.05, 1.1,  1.25, 1.5,  2,     3,     4,      5,     10,   20};
  constexpr double kWorthIt = 0.6;  // of the distance under the right number
  const double given = edit.number, right = given != 0 ? given : 1;
  size_t best = 0;
  double least = 0;
  bool all = samples == Samples::few;
  const auto at = [&](double factor) {
    edit.number = factor * right;
    return distance(edit, all);
  };
  for (;; all = true) {
    edit.number = given, least = HUGE_VAL;
    const double now = distance(edit, all);
    for (size_t i = 0; i < std::size(kGrid); ++i)
      if (const double d = at(kGrid[i]); d < least) least = d, best = i;
    if (!(least < kWorthIt * now)) return false;
    if (all) break;
  }
  double low = kGrid[best == 0 ? 0 : best - 1], high = kGrid[std::min(best + 1, std::size(kGrid) - 1)];
  constexpr double kGolden = 0.6180339887498949;
  double p = high - kGolden * (high - low), q = low + kGolden * (high - low), at_p = at(p), at_q = at(q);
  for (int i = 0; i < 20; ++i) {
    if (at_p <= at_q) {
      high = q, q = p, at_q = at_p, p = high - kGolden * (high - low), at_p = at(p);
    } else {
      low = p, p = q, at_p = at_q, q = low + kGolden * (high - low), at_q = at(q);
    }
  }
  const double middle = at_p <= at_q ? p : q;
  edit.number = (at(middle) <= least ? middle : kGrid[best]) * right;
  return true;
}

}  // namespace trueshade::programs
