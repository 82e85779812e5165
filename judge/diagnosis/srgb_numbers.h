#pragma once
#include <cmath>

#include "judge/legal/level_range.h"

namespace trueshade::oracle {

// Encodes and decodes sRGB values of any size, for planes that hold numbers beyond 1 too; numbers below 0 become 0.
// srgb_decoded() of judge/legal/level_range.h clamps to 1.
inline double encoded_srgb(double v) { return v <= 0 ? 0 : srgb_encoded(v); }
inline double decoded_srgb(double v) {
  return v <= 0 ? 0 : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace trueshade::oracle
