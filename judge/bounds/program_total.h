#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "judge/bounds/program_bounds.h"

namespace trueshade::oracle {

/// Adds up what lights give to one surface, and by how much the roundings of these additions may move the sum: the
/// bound of docs/gl_rules.md section 6.
struct ProgramTotal {
  LitRange lit;
  std::array<double, 3> magnitude{};
  int added = 0;

  /// Sets channel k of what the sum starts from. Called for each channel, before any light is added.
  void start(size_t k, const Interval& x) {
    lit.color[k] = bounded_of(x);
    lit.undefined = lit.undefined || x.maybe_nan || !std::isfinite(lit.color[k].error);
    magnitude[k] = x.size();
    if (magnitude[k] > 0) added = 1;
  }

  /// Adds one light.
  ///   outcomes: what it may add, one for each way that comparisons may go
  ///   nominal:  the outcome of real arithmetic; nothing where, nominally, the light does not reach the surface
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

  /// Adds another result of a light: as a branch or, where it lies within the bound of the chosen one, to the error.
  void add(const OtherBranch& other, const std::array<Bounded, 3>& chosen) {
    bool differs = false;
    for (size_t k = 0; k < 3; ++k) differs = differs || !(std::fabs(other.change[k]) <= chosen[k].error);
    if (!differs) {
      for (size_t k = 0; k < 3; ++k) lit.color[k].error += std::fabs(other.change[k]);
      return;
    }
    lit.branches.push_back(other);
  }

  /// Adds what lights of a block add, and sets the counts of lights to theirs.
  void add(const ProgramBounds::BlockSum& sum) {
    added += sum.added;
    lit.lights_low = sum.lights_low, lit.lights_high = sum.lights_high;
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k].value += sum.color[k].value, lit.color[k].error += sum.color[k].error;
      magnitude[k] += sum.magnitude[k];
    }
  }

  /// The sum, with what the roundings of its additions may move it by in its error. Called once, at the end.
  LitRange finished(double roundoff) {
    for (size_t k = 0; k < 3 && added > 1; ++k)
      lit.color[k].error += (added - 1) * roundoff * (magnitude[k] + lit.color[k].error);
    return std::move(lit);
  }
};

}  // namespace trueshade::oracle
