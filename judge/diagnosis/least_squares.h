#pragma once
// Three numbers by least squares, from residuals of which many may have another cause.
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// A symmetric system of three equations.
struct NormalEquations {
  std::array<Triple3, 3> a{};
  Triple3 b{};

  /// The solution of a x = b once each element of the diagonal has grown by `damping` times itself; nothing where the
  /// system is singular.
  std::optional<Triple3> solved(double damping) const {
    std::array<Triple3, 3> m = a;
    // A direction has a length to spare, along which nothing pulls: the trace keeps steps from growing there.
    const double trace = a[0][0] + a[1][1] + a[2][2];
    for (size_t k = 0; k < 3; ++k) m[k][k] += damping * a[k][k] + 1e-6 * trace;
    const Triple3 yz = cross(m[1], m[2]), zx = cross(m[2], m[0]), xy = cross(m[0], m[1]);
    const double determinant = inner(m[0], yz);
    if (!(std::fabs(determinant) > 0)) return std::nullopt;
    const Triple3 sum = plus(plus(times(yz, b[0]), times(zx, b[1])), times(xy, b[2]));
    return times(sum, 1 / determinant);
  }
};

/// The residual of each measurement at three numbers, always as many residuals. NaN or infinite: there is nothing to
/// compare.
using Residuals = std::function<std::vector<double>(const Triple3& at)>;

/// What three numbers are fitted to.
struct LeastSquares {
  Residuals residuals;
  int numbers = 3;                 ///< how many of the three are fitted
  double size = 1e-4;              ///< of a small change of a number
  std::span<const double> scales;  ///< residuals beyond which another cause is likely; descending
  double none = 0;                 ///< the value of a number that changes nothing
};

/// The sum of residuals by Cauchy's rule, log(1 + (r / scale)^2), each 20 at most. One that is NaN or infinite counts
/// for 20, or for 1 at scales below 1e-3.
double robust_error(const std::vector<double>& residuals, double scale);

/// The numbers that fit best, from `at` by Levenberg and Marquardt's steps, with each scale in turn; at the middle one
/// it looks about along each number too. Then numbers whose change shows in no residual are set to `none`, and all are
/// rounded to the coarsest unit that fits as well, where one does. Asks for the residuals some hundreds of times.
Triple3 fitted(const LeastSquares& problem, Triple3 at);

}  // namespace trueshade::oracle
