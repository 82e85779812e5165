#pragma once
#include <algorithm>
#include <cmath>

namespace trueshade::testing {

// IEC 61966-2-1, in double; written again because the renderer's codes come from tables of exact steps (core/srgb.h).
/// `linear` in [0, 1]; the code in [0, 1].
inline double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
/// `code` below 1; 0 where it is below 0.
inline double srgb_decoded(double code) {
  return code <= 0.04045 ? std::max(code, 0.0) / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace trueshade::testing
