#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace trueshade {

/// x^(1/5) for x in (0, 1], to the last bits of a double; + - * / only, so that tables built from it are the same
/// everywhere.
constexpr double fifth_root(double x) {
  double root = 1.0;  // Newton on r^5 = x falls monotonically from any start above the root
  for (int step = 0; step < 100; ++step) {
    const double square = root * root;
    root = (4.0 * root + x / (square * square)) / 5.0;
  }
  return root;
}

/// The linear value of an sRGB value in [0, 1] (IEC 61966-2-1: exponent 2.4, which is 12/5).
constexpr double linear_from_srgb(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  const double base = (srgb + 0.055) / 1.055;
  const double root = fifth_root(base);
  return base * base * (root * root);
}

/// Linear values at which the nearest sRGB code changes: element k is where code k + 1 begins.
inline constexpr std::array<double, 255> kSrgbCodeStarts = [] {
  std::array<double, 255> starts{};
  for (size_t k = 0; k < starts.size(); ++k) starts[k] = linear_from_srgb((double(k) + 0.5) / 255.0);
  return starts;
}();

/// The same as floats: the least float that has code k + 1, and infinity at the end.
inline constexpr std::array<float, 256> kSrgbCodeFloats = [] {
  std::array<float, 256> starts{};
  for (size_t k = 0; k < kSrgbCodeStarts.size(); ++k) {
    const auto near = float(kSrgbCodeStarts[k]);
    const bool below = double(near) < kSrgbCodeStarts[k];
    starts[k] = below ? std::bit_cast<float>(std::bit_cast<uint32_t>(near) + 1) : near;
  }
  starts[255] = std::numeric_limits<float>::infinity();
  return starts;
}();

/// The linear value of each 8-bit sRGB code, rounded once.
inline constexpr std::array<float, 256> kLinearOfSrgb8 = [] {
  std::array<float, 256> values{};
  for (size_t k = 0; k < values.size(); ++k) values[k] = float(linear_from_srgb(double(k) / 255.0));
  return values;
}();

/// The nearest 8-bit sRGB code of a linear value, clamped to [0, 255]; NaN gives 0. A search, so no pow() takes part.
inline uint8_t srgb8_from_linear(float linear) {
  if (!(linear > 0.0f)) return 0;
  const auto* above = std::upper_bound(kSrgbCodeStarts.begin(), kSrgbCodeStarts.end(), double(linear));
  return uint8_t(above - kSrgbCodeStarts.begin());
}

}  // namespace trueshade
