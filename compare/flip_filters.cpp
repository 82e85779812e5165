// Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild: "FLIP: A
// Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques
// 3 (2), 2020: section 4.1.1 and table 1 (contrast sensitivity), section 4.2 (features).
#include "compare/flip_filters.h"

#include <cmath>
#include <numbers>

namespace trueshade::compare {
namespace {

constexpr double kPi = std::numbers::pi;

/// Row of the table: weight and width of a Gaussian in the frequency domain.
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm kAchromatic{1.0, 0.0047}, kRedGreen{1.0, 0.0053}, kBlueYellow{34.1, 0.04},
    kBlueYellowSecond{13.5, 0.025};
constexpr double kWidestTerm = 0.04;
constexpr double kFeatureDegrees = 0.082;  ///< width of the features that the eye is most sensitive to

std::vector<double> gaussian(double b, double pixels_per_degree, int radius) {
  std::vector<double> half;
  for (int x = 0; x <= radius; ++x) {
    const double degrees = x / pixels_per_degree;
    half.push_back(std::exp(-kPi * kPi * degrees * degrees / b));
  }
  return half;
}

/// Of both halves.
double whole_sum(const std::vector<double>& half) {
  double sum = half[0];
  for (size_t x = 1; x < half.size(); ++x) sum += 2.0 * half[x];
  return sum;
}

HalfFilter scaled(const std::vector<double>& half, double scale) {
  HalfFilter filter;
  for (const double weight : half) filter.push_back(float(weight * scale));
  return filter;
}

HalfFilter normalized(const std::vector<double>& half) { return scaled(half, 1.0 / whole_sum(half)); }

/// Scales positive weights to a sum of 1 and negative ones to -1, over both halves.
HalfFilter normalized_by_sign(const std::vector<double>& half, bool antisymmetric) {
  double positive = 0.0, negative = 0.0;
  for (size_t x = 0; x < half.size(); ++x) {
    const double times = x == 0 || antisymmetric ? 1.0 : 2.0;
    if (half[x] > 0)
      positive += times * half[x];
    else
      negative -= times * half[x];
  }
  if (antisymmetric) positive = negative = positive + negative;  // each half has the one, negated, of the other
  HalfFilter filter;
  for (const double weight : half) filter.push_back(float(weight / (weight > 0 ? positive : negative)));
  return filter;
}

}  // namespace

FlipFilters flip_filters(double pixels_per_degree) {
  FlipFilters f;
  const int radius = int(std::ceil(3.0 * std::sqrt(kWidestTerm / (2.0 * kPi * kPi)) * pixels_per_degree));
  f.achromatic = normalized(gaussian(kAchromatic.b, pixels_per_degree, radius));
  f.red_green = normalized(gaussian(kRedGreen.b, pixels_per_degree, radius));
  const std::vector<double> first = gaussian(kBlueYellow.b, pixels_per_degree, radius),
                            second = gaussian(kBlueYellowSecond.b, pixels_per_degree, radius);
  const double first_scale = kBlueYellow.a * std::sqrt(kPi / kBlueYellow.b),
               second_scale = kBlueYellowSecond.a * std::sqrt(kPi / kBlueYellowSecond.b);
  const double total =
      first_scale * whole_sum(first) * whole_sum(first) + second_scale * whole_sum(second) * whole_sum(second);
  f.blue_yellow = scaled(first, std::sqrt(first_scale / total));
  f.blue_yellow_wide = scaled(second, std::sqrt(second_scale / total));

  const double deviation = 0.5 * kFeatureDegrees * pixels_per_degree;  // pixels
  const int feature_radius = int(std::ceil(3.0 * deviation));
  std::vector<double> smooth, edge, point;
  for (int x = 0; x <= feature_radius; ++x) {
    const double g = std::exp(-double(x) * x / (2.0 * deviation * deviation));
    smooth.push_back(g);
    edge.push_back(-x * g);
    point.push_back((double(x) * x / (deviation * deviation) - 1.0) * g);
  }
  f.smooth = normalized(smooth);
  f.edge = normalized_by_sign(edge, true);
  f.point = normalized_by_sign(point, false);
  return f;
}

}  // namespace trueshade::compare
