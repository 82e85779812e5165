#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "judge/bounds/program_bounds.h"

namespace trueshade::oracle {

/// Adds up what lights give to one surface, and bounds how far the roundings of the additions may move the sum
/// (docs/gl_rules.md section 6). `magnitude`: the sum of the terms' largest sizes; `added`: how many terms are not 0.
struct ProgramTotal {
  LitRange lit;
  std::array<double, 3> magnitude{};
  int added = 0;

  /// Sets channel k (0 to 2) of what the sum starts from. Call it for each channel before any light is added.
  void start(size_t k, const Interval& x) {
    lit.color[k] = bounded_of(x);
    lit.undefined = lit.undefined || x.maybe_nan || !std::isfinite(lit.color[k].error);
    magnitude[k] = x.size();
    if (magnitude[k] > 0) added = 1;
  }

  /// Adds one light's term, RGB.
  ///   outcomes: what the term may be, one for each way that comparisons may go
  ///   nominal:  index of the outcome of real arithmetic; nothing where, by it, the light does not reach the surface
  ///   perhaps_nothing: the light may not reach the surface
  void add(std::span<const std::array<Interval, 3>> outcomes, std::optional<size_t> nominal, bool perhaps_nothing) {
    std::array<Bounded, 3> chosen{};
    bool is_dark = true;  // adding a zero rounds nothing
    for (size_t k = 0; k < 3; ++k) {
      double largest = 0;
      for (const auto& one : outcomes) {
        const Bounded b = bounded_of(one[k]);
        lit.undefined = lit.undefined || one[k].maybe_nan || !std::isfinite(b.error);
        chosen[k].error = std::max(chosen[k].error, b.error), largest = std::max(largest, one[k].size());
      }
      if (nominal) chosen[k].value = outcomes[*nominal][k].value;
      lit.color[k].value += chosen[k].value, lit.color[k].error += chosen[k].error;
      magnitude[k] += largest;
      is_dark = is_dark && largest == 0;
    }
    added += !is_dark;
    for (size_t i = 0; i < outcomes.size(); ++i) {
      OtherBranch other;
      for (size_t k = 0; k < 3; ++k) other.change[k] = outcomes[i][k].value - chosen[k].value;
      if (i != nominal) add(other, chosen);
    }
    OtherBranch none;
    for (size_t k = 0; k < 3; ++k) none.change[k] = -chosen[k].value;
    if (perhaps_nothing && nominal) add(none, chosen);
  }

  /// Adds another outcome of a light that is added already, given as its difference to the chosen one. It widens the
  /// error where it lies within the chosen one's bound in every channel; otherwise it becomes a branch.
  void add(const OtherBranch& other, const std::array<Bounded, 3>& chosen) {
    bool differs = false;
    for (size_t k = 0; k < 3; ++k) differs = differs || !(std::fabs(other.change[k]) <= chosen[k].error);
    if (!differs) {
      for (size_t k = 0; k < 3; ++k) lit.color[k].error += std::fabs(other.change[k]);
      return;
    }
    lit.branches.push_back(other);
  }

  /// Adds the lights of a block to the sum. The counts of lights are set to the block's, not added.
  void add(const ProgramBounds::BlockSum& sum) {
    added += sum.added;
    lit.lights_low = sum.lights_low, lit.lights_high = sum.lights_high;
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k].value += sum.color[k].value, lit.color[k].error += sum.color[k].error;
      magnitude[k] += sum.magnitude[k];
    }
  }

  /// Returns the sum, after its error is widened by the roundings of the additions. Call it once, at the end.
  ///   roundoff: relative error of one addition
  LitRange finished(double roundoff) {
    for (size_t k = 0; k < 3 && added > 1; ++k)
      lit.color[k].error += (added - 1) * roundoff * (magnitude[k] + lit.color[k].error);
    return std::move(lit);
  }
};

}  // namespace trueshade::oracle
