#pragma once
#include <algorithm>
#include <cmath>

#include "core/image.h"

namespace trueshade::testing {

/// How far two pictures are apart at a pixel, in codes of 8 bits: of the first `channels` channels the worst.
inline double codes_apart(const Image& a, const Image& b, int x, int y, int channels = 3) {
  double worst = 0;
  for (int k = 0; k < channels; ++k) worst = std::max(worst, std::fabs(255 * (a.value(x, y, k) - b.value(x, y, k))));
  return worst;
}

/// The sum of what `a` is brighter than `b`, R, G and B, in codes.
inline double codes_brighter(const Image& a, const Image& b, int x, int y) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += 255 * (a.value(x, y, k) - b.value(x, y, k));
  return sum;
}

}  // namespace trueshade::testing
