#pragma once
#include <array>

#include "core/srgb.h"

namespace trueshade {

/// The float a lookup reads from an 8-bit code: RN(k / 255), and of sRGB codes the linear value, rounded once.
inline constexpr std::array<float, 256> kValueOfUnorm8 = [] {
  std::array<float, 256> values{};
  for (size_t k = 0; k < values.size(); ++k) values[k] = float(k) / 255.0f;
  return values;
}();
inline constexpr std::array<float, 256> kLinearOfSrgb8Code = [] {
  std::array<float, 256> values{};
  for (size_t k = 0; k < values.size(); ++k) values[k] = float(linear_from_srgb(double(k) / 255.0));
  return values;
}();

}  // namespace trueshade
