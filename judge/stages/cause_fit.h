#pragma once
// How much of each of several causes a plane's deviations show: least squares within bounds.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trueshade::oracle {

/// A channel of a pixel: how far it is from nominal, and what one unit of each cause would make of it.
struct Deviation {
  double given = 0;              ///< stored less nominal, in steps of the plane
  std::vector<double> by_cause;  ///< of one unit, in the same steps; as many as there are causes
  uint64_t cluster = 0;          ///< deviations of one cluster are one choice: equal values round alike
  uint32_t place = 0;            ///< what is left at one place may be alike, whatever the values
  double noise = 0;              ///< what rounding makes of the deviation, a standard deviation
};

/// What an implementation may have of a cause, as one number for the whole picture.
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

  /// A standard deviation: the larger of `error` and `error_of_places`, the latter widened, as few places make it, so
  /// that `deviations` times the result is exceeded as rarely as by a normal distribution. Infinite where there are
  /// fewer than two places. `deviations` is above 0.
  double error_at(double deviations) const;
};

/// The least sum of squares, over clusters, that causes within their bounds leave of the deviations; 0 of none.
double left_within(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds);

/// Each cause's estimate. A cluster counts once, however many deviations it has. A cause that no deviation shows is 0,
/// with an infinite error. Errors are those of clusters, whatever
/// is behind them: White's estimator (Halbert White, A Heteroskedasticity-Consistent Covariance Matrix Estimator,
/// Econometrica 48, 1980), over clusters.
std::vector<CauseEstimate> estimate_causes(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds);

}  // namespace trueshade::oracle
