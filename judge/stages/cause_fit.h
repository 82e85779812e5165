#pragma once
// Least squares: how much of each of several causes explains how far a plane is from its nominal values.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trueshade::oracle {

/// How far one channel of a pixel is from its nominal value, and how far one unit of each cause would move it.
struct Deviation {
  double given = 0;              ///< stored minus nominal: in codes where the plane has codes, else in its own unit
  std::vector<double> by_cause;  ///< of one unit, in the same steps; as many as there are causes
  uint64_t cluster = 0;          ///< deviations of one cluster count as one: equal values round alike
  uint32_t place = 0;            ///< what the fit leaves may be alike at one place (pixels near each other)
  double noise = 0;              ///< standard deviation of what rounding makes of the deviation
};

/// The amounts of a cause that an implementation may have, one amount for the whole picture. 24^ How much of one cause
/// the deviations show.
struct CauseBounds {
  double low = 0, high = 0;
};

struct CauseEstimate {
  double value = 0;   ///< the likeliest where this cause has no bounds and the others keep theirs
  double beyond = 0;  ///< how far it would go from its value within bounds if it alone had none, and causes at a bound
                      ///< stayed there; about 0 where no bound holds it
  double error = 0;   ///< its standard deviation, from how much clusters differ and from their noise; infinite where
                      ///< the other causes may do the same
  double error_of_places = 0;  ///< the same from how much places differ, where what is left is alike
  size_t places = 0;

  /// A standard deviation of `value` such that `deviations` (above 0) times it is exceeded as rarely as by a normal
  /// distribution: the larger of `error` and `error_of_places`, the latter widened where places are few. Infinite where
  /// there are fewer than two places.
  double error_at(double deviations) const;
};

/// The least sum of squares, each cluster counted once, that any amounts of the causes within their bounds leave of the
/// deviations; 0 where there are no deviations.
double left_within(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds);

/// Estimates each cause; the result has as many elements as `bounds`. A cluster counts once, however many deviations it
/// has. A cause that no deviation shows is 0, with an infinite error. Errors follow from how the clusters scatter,
/// whatever the reason: White's estimator (Halbert White, A Heteroskedasticity-Consistent Covariance Matrix Estimator,
/// Econometrica 48, 1980), over clusters.
std::vector<CauseEstimate> estimate_causes(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds);

}  // namespace trueshade::oracle
