#pragma once
// sRGB as real numbers, of values beyond 1 too; 0 of those below 0.
#include <cmath>

namespace trueshade::oracle {

inline double encoded_srgb(double v) {
  return v <= 0 ? 0 : v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}
inline double decoded_srgb(double v) {
  return v <= 0 ? 0 : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace trueshade::oracle
