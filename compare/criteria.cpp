#include "compare/criteria.h"

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
  const std::string measured = number_text(row.measured), bound = number_text(row.criterion.bound);
  switch (row.criterion.measure) {
    case Measure::unequal_pixels:
      return "unequal pixels " + measured + " (at most " + bound + ")";
    case Measure::largest_difference:
      return "largest difference " + measured + " (at most " + bound + ")";
    case Measure::largest_ulp:
      return "largest difference in ULP " + measured + " (at most " + bound + ")";
    case Measure::pixels_beyond:
      return "pixels that differ by more than " + number_text(row.criterion.delta) + ": " + measured + " (at most " +
             bound + ")";
    case Measure::window_share: {
      const std::string side = std::to_string(row.criterion.side);
      return "share of pixels that differ by more than " + number_text(row.criterion.delta) + " in a window of " +
             side + "x" + side + ": " + measured + " (at most " + bound + ")";
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
