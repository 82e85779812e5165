#pragma once
#include <vector>

namespace trueshade::compare {

/// One half of a filter whose other half follows from symmetry: weights of distances 0, 1, 2, ... pixels.
using HalfFilter = std::vector<float>;

/// The filters of FLIP for a number of pixels per degree of the visual field.
///   contrast: the eye's contrast sensitivity as a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
///     Each Gaussian of two dimensions is a product of two of one; the weights of all add up to 1.
///   features: a Gaussian and its two derivatives, whose positive and negative weights add up to 1 and to -1.
struct FlipFilters {
  HalfFilter achromatic, red_green;          ///< of Y and Cx
  HalfFilter blue_yellow, blue_yellow_wide;  ///< of Cz: two that are added
  HalfFilter smooth, edge, point;            ///< `edge` is antisymmetric: the weight at -x is that at x, negated
};
FlipFilters flip_filters(double pixels_per_degree);

}  // namespace trueshade::compare
