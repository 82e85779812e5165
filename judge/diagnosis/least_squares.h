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

  /// Solved with so much added to the diagonal; nothing where it is singular.
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

/// What is left of each measurement at three numbers, always as many; not a number: there is nothing to compare.
using Residuals = std::function<std::vector<double>(const Triple3& at)>;

/// What three numbers are fitted to.
struct LeastSquares {
  Residuals residuals;
  int numbers = 3;                 ///< of the three, that are looked for
  double size = 1e-4;              ///< of a small change
  std::span<const double> scales;  ///< residuals beyond which there is another cause, from the widest
  double none = 0;                 ///< of each number: what changes nothing
};

/// The sum by Cauchy's rule; what cannot be compared counts for as much as what is far off.
double robust_error(const std::vector<double>& residuals, double scale);

/// Levenberg and Marquardt's steps from `at`, with each scale in turn; then the shortest numbers that fit as well,
/// those that no residual shows left at what changes nothing.
Triple3 fitted(const LeastSquares& problem, Triple3 at);

}  // namespace trueshade::oracle
