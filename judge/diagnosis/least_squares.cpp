#include "judge/diagnosis/least_squares.h"

#include <algorithm>

namespace trueshade::oracle {

namespace {

/// The normal equations of a step from `at`, whose residuals are `here`, each weighed by Cauchy's rule. Residuals that
/// are not finite, there or beside, do not count.
NormalEquations equations_of(const LeastSquares& problem, const Triple3& at, const std::vector<double>& here,
                             double scale) {
  std::array<std::vector<double>, 3> moved;
  const auto numbers = size_t(problem.numbers);
  for (size_t k = 0; k < numbers; ++k) {
    Triple3 there = at;
    there[k] += problem.size;
    moved[k] = problem.residuals(there);
  }
  NormalEquations n;
  for (size_t i = 0; i < here.size(); ++i) {
    if (!std::isfinite(here[i])) continue;
    Triple3 slope{};
    for (size_t k = 0; k < numbers; ++k) slope[k] = (moved[k][i] - here[i]) / problem.size;
    if (!std::isfinite(slope[0] + slope[1] + slope[2])) continue;
    const double weight = 1 / (1 + here[i] * here[i] / (scale * scale));
    for (size_t k = 0; k < 3; ++k) {
      n.b[k] -= weight * slope[k] * here[i];
      for (size_t j = 0; j < 3; ++j) n.a[k][j] += weight * slope[k] * slope[j];
    }
  }
  return n;
}

/// Moves `at` by Levenberg and Marquardt's steps for as long as the error falls.
void descend(const LeastSquares& problem, double scale, Triple3& at) {
  std::vector<double> here = problem.residuals(at);
  double least = robust_error(here, scale), damping = 1e-3;
  for (int i = 0; i < 12 && damping < 1e5; ++i) {
    const std::optional<Triple3> step = equations_of(problem, at, here, scale).solved(damping);
    if (!step) return;
    const Triple3 next = plus(at, *step);
    std::vector<double> there = problem.residuals(next);
    const double error = robust_error(there, scale);
    if (!(error < least)) {
      damping *= 16;
      continue;
    }
    const bool done = least - error < 1e-6 * least;
    at = next, least = error, here = std::move(there), damping = std::max(1e-9, damping / 16);
    if (done) return;
  }
}

/// Moves `at` by steps along each number, ever smaller, for as long as they lead to less: what appears or vanishes has
/// no slope.
void look_about(const LeastSquares& problem, double scale, Triple3& at) {
  double least = robust_error(problem.residuals(at), scale);
  for (double step = 16 * problem.size; step >= problem.size; step /= 2)
    for (size_t k = 0; k < size_t(problem.numbers); ++k)
      for (const double sign : {-1.0, 1.0}) {
        Triple3 next = at;
        next[k] += sign * step;
        const double error = robust_error(problem.residuals(next), scale);
        if (error < least * (1 - 1e-6)) at = next, least = error;
      }
}

}  // namespace

double robust_error(const std::vector<double>& residuals, double scale) {
  constexpr double kMost = 20, kCoarse = 1e-3;
  // Where little is left to fit, a sample more or less at an edge must not stand in the way.
  const double missing = scale >= kCoarse ? kMost : 1;
  double sum = 0;
  for (const double r : residuals)
    sum += std::isfinite(r) ? std::min(kMost, std::log1p(r * r / (scale * scale))) : missing;
  return sum;
}

Triple3 fitted(const LeastSquares& problem, Triple3 at) {
  for (size_t i = 0; i < problem.scales.size(); ++i) {
    descend(problem, problem.scales[i], at);
    if (i == problem.scales.size() / 2) look_about(problem, problem.scales[i], at);
  }
  const double last = problem.scales.back(), middle = problem.scales[problem.scales.size() / 2];
  const std::vector<double> left = problem.residuals(at);
  const auto fits_as_well = [&](const std::vector<double>& residuals) {
    return robust_error(residuals, last) <= robust_error(left, last) * 1.01 + 1e-9 &&
           robust_error(residuals, middle) <= robust_error(left, middle) * 1.01 + 1e-3;
  };
  for (size_t k = 0; k < size_t(problem.numbers); ++k) {
    Triple3 without = at;
    without[k] = problem.none;
    if (fits_as_well(problem.residuals(without))) at = without;
  }
  for (const double unit : {1.0, 0.5, 0.1, 0.05, 0.01, 1e-3, 1e-4, 1e-5}) {
    Triple3 rounded{};
    for (size_t k = 0; k < size_t(problem.numbers); ++k) rounded[k] = std::nearbyint(at[k] / unit) * unit + 0.0;
    if (fits_as_well(problem.residuals(rounded))) return rounded;
  }
  return at;
}

}  // namespace trueshade::oracle
