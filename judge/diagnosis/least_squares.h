#pragma once
// Fits three numbers by least squares, where many residuals may have another cause.
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The normal equations a x = b of a step with three unknowns; `a` is symmetric.
struct NormalEquations {
  std::array<Triple3, 3> a{};
  Triple3 b{};

  /// Solves them after each diagonal element is increased by `damping` times itself (and a 1e-6 of the trace). Nothing
  /// where the system is singular.
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

/// Computes the residual of each measurement for three numbers; always as many residuals. One that is NaN or infinite
/// cannot be compared.
using Residuals = std::function<std::vector<double>(const Triple3& at)>;

/// A problem of least squares: which numbers are fitted to which residuals.
struct LeastSquares {
  Residuals residuals;
  int numbers = 3;                 ///< how many of the three are fitted
  double size = 1e-4;              ///< the difference that slopes are measured by
  std::span<const double> scales;  ///< residuals beyond which another cause is likely; descending
  double none = 0;                 ///< the value of a number that stands for no change
};

/// The sum over all residuals of log(1 + (r / scale)^2), Cauchy's rule, each at most 20. A residual that is NaN or
/// infinite counts as 20, or as 1 at scales below 1e-3.
double robust_error(const std::vector<double>& residuals, double scale);

/// Fits the numbers, beginning at `at`, by steps of Levenberg and Marquardt, at each scale in turn; at the middle scale
/// it also tries steps along each number. Then sets numbers that hardly change the residuals to `none`, and rounds all
/// to the coarsest unit that fits as well, if one does. Asks for the residuals some hundreds of times.
Triple3 fitted(const LeastSquares& problem, Triple3 at);

}  // namespace trueshade::oracle
