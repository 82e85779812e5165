#pragma once
#include <bit>
#include <cstdint>

#include "core/format.h"

namespace trueshade {

/// IEEE 754 binary16 of a float, by integers alone, so that no CPU's conversion instruction or rounding mode takes
/// part. toward_zero: magnitudes from 65504 up to the largest float give 65504 (7BFF); nearest: ties to even, from
/// 65520 on infinity. Both keep infinities, the sign of zero and denormal halves; a NaN stays one, made quiet, its top
/// bits kept.
/// Pixels are rounded by core/simd/store-inl.h, to the same bits.
constexpr uint16_t half_from_float(float value, HalfRound round) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const uint32_t sign = (bits >> 16) & 0x8000u;
  const uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return uint16_t(sign | 0x7e00u | ((magnitude >> 13) & 0x3ffu));
  if (magnitude == 0x7f800000u) return uint16_t(sign | 0x7c00u);

  const int exponent = int(magnitude >> 23) - 127;
  if (exponent > 15) return uint16_t(sign | (round == HalfRound::toward_zero ? 0x7bffu : 0x7c00u));
  if (exponent < -25) return uint16_t(sign);  // below half of the least half, 2^-24

  // Below 2^-14 a half has no leading one of its own: the significand, leading one written out, moves further right.
  const bool denormal = exponent < -14;
  const uint32_t significand = denormal ? (magnitude & 0x7fffffu) | 0x800000u : magnitude - (uint32_t(127 - 15) << 23);
  const int shift = denormal ? 13 + (-14 - exponent) : 13;
  const uint32_t truncated = significand >> shift;
  if (round == HalfRound::toward_zero) return uint16_t(sign | truncated);
  const uint32_t rest = significand & ((1u << shift) - 1u);
  const uint32_t tie = 1u << (shift - 1);
  const uint32_t up = rest > tie || (rest == tie && (truncated & 1u) != 0) ? 1u : 0u;
  return uint16_t(sign | (truncated + up));  // a carry out of the fraction is the next exponent, 7BFF + 1 infinity
}

/// The float equal to a half; every half has one. A NaN keeps its payload in the top bits.
constexpr float float_from_half(uint16_t half) {
  const uint32_t sign = uint32_t(half & 0x8000u) << 16;
  const uint32_t exponent = (half >> 10) & 0x1fu;
  const uint32_t fraction = half & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | (fraction << 13));
  if (exponent != 0) return std::bit_cast<float>(sign | ((exponent + 112) << 23) | (fraction << 13));
  if (fraction == 0) return std::bit_cast<float>(sign);
  const int top = 31 - std::countl_zero(fraction);  // value = fraction * 2^-24, its leading one at bit `top`
  return std::bit_cast<float>(sign | (uint32_t(top + 103) << 23) | ((fraction << (23 - top)) & 0x7fffffu));
}

}  // namespace trueshade
