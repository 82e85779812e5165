#include "compare/criteria.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace trueshade::compare {
namespace {

std::string number_text(double value) {
  char text[40];
  const bool is_count = value == std::floor(value) && std::fabs(value) < 1e15;
  std::snprintf(text, sizeof text, is_count ? "%.0f" : "%.6g", value);
  return text;
}

std::string given_text(const std::string& given, double value) { return given.empty() ? number_text(value) : given; }

/// `2/255` where the bound was given as a fraction of 255, and 255 times the value is whole, from 1 on, but for what
/// floats round.
std::string measured_text(const Judged& row) {
  constexpr double kWhole = 1e-5;
  const std::string& given = row.criterion.bound_text;
  const size_t slash = given.find('/');
  if (slash == std::string::npos) return number_text(row.measured);
  double below = 0.0;
  std::from_chars(given.data() + slash + 1, given.data() + given.size(), below);
  const double above = row.measured * below, whole = std::round(above);
  if (whole == 0.0 || !(std::fabs(above - whole) <= kWhole)) return number_text(row.measured);
  return number_text(whole) + given.substr(slash);
}

}  // namespace

Judged judged(const Criterion& criterion, double measured) {
  const bool at_least = criterion.measure == Measure::psnr;
  return {criterion, measured, at_least ? measured >= criterion.bound : measured <= criterion.bound};  // NaN fails
}

std::string_view name_of(Measure measure) {
  switch (measure) {
    case Measure::unequal_pixels:
      return "unequal_pixels";
    case Measure::largest_difference:
      return "largest_difference";
    case Measure::largest_ulp:
      return "largest_ulp";
    case Measure::pixels_beyond:
      return "pixels_beyond";
    case Measure::window_share:
      return "window_share";
    case Measure::psnr:
      return "psnr";
    case Measure::flip_mean:
      return "flip_mean";
    case Measure::flip_weighted_median:
      return "flip_weighted_median";
  }
  return {};  // unreachable: every enumerator returns above
}

std::string text_of(const Judged& row) {
  const std::string measured = measured_text(row), bound = given_text(row.criterion.bound_text, row.criterion.bound),
                    delta = given_text(row.criterion.delta_text, row.criterion.delta);
  switch (row.criterion.measure) {
    case Measure::unequal_pixels:
      return "unequal pixels " + measured + " (at most " + bound + ")";
    case Measure::largest_difference:
      return "largest difference " + measured + " (at most " + bound + ")";
    case Measure::largest_ulp:
      return "largest difference in ULP " + measured + " (at most " + bound + ")";
    case Measure::pixels_beyond:
      return "pixels that differ by more than " + delta + ": " + measured + " (at most " + bound + ")";
    case Measure::window_share: {
      const std::string side = std::to_string(row.criterion.side);
      return "share of pixels that differ by more than " + delta + " in a window of " + side + "x" + side + ": " +
             measured + " (at most " + bound + ")";
    }
    case Measure::psnr:
      return "least PSNR " + measured + " dB (at least " + bound + ")";
    case Measure::flip_mean:
      return "FLIP, mean " + measured + " (at most " + bound + ")";
    case Measure::flip_weighted_median:
      return "FLIP, weighted median " + measured + " (at most " + bound + ")";
  }
  return {};  // unreachable: every enumerator returns above
}

}  // namespace trueshade::compare
