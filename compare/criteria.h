#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trueshade::compare {

/// What a criterion measures of two pictures. Each but the last two is over every channel.
enum class Measure : uint8_t {
  unequal_pixels,       ///< pixels whose stored values are not all equal: the criterion where none is asked for
  largest_difference,   ///< of two values
  largest_ulp,          ///< steps of the storage between two values
  pixels_beyond,        ///< pixels with a channel that differs by more than `delta`
  window_share,         ///< the largest share of such pixels that a window of `side` pixels has
  psnr,                 ///< dB, the least of any channel; at least the bound
  flip_mean,            ///< mean of the FLIP map of R, G and B
  flip_weighted_median  ///< weighted median of the same
};

/// A row: what must hold, or the pictures differ.
struct Criterion {
  Measure measure = Measure::unequal_pixels;
  double bound = 0.0;                      ///< at most; of psnr at least
  double delta = 0.0;                      ///< of pixels_beyond and window_share
  int side = 0;                            ///< of window_share
  std::string bound_text{}, delta_text{};  ///< as they were given, like 2/255; empty: as decimals
};

/// A criterion and what was measured.
struct Judged {
  Criterion criterion;
  double measured = 0.0;
  bool holds = false;
};

Judged judged(const Criterion& criterion, double measured);

constexpr bool is_flip(Measure measure) {
  return measure == Measure::flip_mean || measure == Measure::flip_weighted_median;
}
constexpr bool has_delta(Measure measure) {
  return measure == Measure::pixels_beyond || measure == Measure::window_share;
}

/// `largest_difference`, ... as JSON has it, and as people read it: `largest difference 0.0157 (at most 0.02)`. Where
/// the bound was given as a fraction, and what was measured is one of the same denominator, it is shown as one.
std::string_view name_of(Measure measure);
std::string text_of(const Judged& row);

}  // namespace trueshade::compare
