#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

/// Sums of products in f32 whose order is written, for values that are lists of 32-bit scalars.
namespace trueshade::oracle::spirv {

using Scalars = std::vector<uint32_t>;
using Reals = std::vector<float>;

inline float real_of(uint32_t bits) { return std::bit_cast<float>(bits); }
inline uint32_t bits_of(float value) { return std::bit_cast<uint32_t>(value); }

inline Reals reals_of(std::span<const uint32_t> scalars) {
  Reals reals;
  for (const uint32_t bits : scalars) reals.push_back(real_of(bits));
  return reals;
}

inline Scalars scalars_of(std::span<const float> reals) {
  Scalars scalars;
  for (const float value : reals) scalars.push_back(bits_of(value));
  return scalars;
}

/// (x0*y0 + x1*y1) + x2*y2 and so on: one product alone, or two to four.
inline float dot_of(std::span<const float> x, std::span<const float> y) {
  float sum = x[0] * y[0];
  for (size_t i = 1; i < x.size(); ++i) sum = sum + x[i] * y[i];
  return sum;
}

}  // namespace trueshade::oracle::spirv
