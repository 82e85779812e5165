#pragma once
#include <span>

namespace trueshade {

/// How many times as long frames of one kind take as those of another.
struct RatioInterval {
  double ratio;      ///< the median of the quotients of all pairs
  double low, high;  ///< hold the true one with the confidence that was asked for; 0 and infinity: too few frames
};

/// After Hodges and Lehmann, Estimates of Location Based on Rank Tests (1963), on logarithms, so that quotients take
/// the place of differences: the interval lies between the quotients that Mann and Whitney's test at that confidence
/// leaves. It takes no distribution of times for granted, only that both have the same shape. Neither may be empty;
/// times above 0. Does not: see what differs from one run to the next, such as where memory lies.
RatioInterval ratio_interval(std::span<const double> before, std::span<const double> after, double confidence);

}  // namespace trueshade
