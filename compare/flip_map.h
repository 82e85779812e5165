#pragma once
#include <array>
#include <vector>

namespace trueshade::compare {

/// A picture's colours as linear light of sRGB primaries, rows from the top.
struct LinearPicture {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> rgb;
};

/// What light becomes before a screen shows it: y = (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5) of x = scale * light,
/// held to [0, 1]. The default shows light as it is.
struct ToneCurve {
  std::array<double, 6> k{0, 1, 0, 0, 0, 1};
  double scale = 1.0;
};

/// FLIP's error of each pixel, in [0, 1], rows from the top: of both pictures under one curve, seen at so many pixels
/// per degree of the visual field. `map` has an element a pixel; each becomes the larger of itself and the error, so
/// that a first call begins with zeros. What is not
/// finite shows as black.
void raise_flip_map(const LinearPicture& reference, const LinearPicture& test, const ToneCurve& curve,
                    double pixels_per_degree, int threads, std::vector<float>& map);

}  // namespace trueshade::compare
