#pragma once
#include <cmath>

#include "judge/legal/level_range.h"

namespace trueshade::oracle {

// sRGB of what a plane may hold: beyond 1 too, where a texel's ends (srgb_decoded() of judge/legal/level_range.h), and 0
// of what is below 0.
inline double encoded_srgb(double v) { return v <= 0 ? 0 : srgb_encoded(v); }
inline double decoded_srgb(double v) {
  return v <= 0 ? 0 : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace trueshade::oracle
