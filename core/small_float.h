#pragma once
#include <bit>
#include <cstdint>

#include "core/half.h"

namespace trueshade {

// The unsigned floats of R11F_G11F_B10F (GL 4.6 core, 2.3.4.3 and 2.3.4.4): halves without a sign, and with 6 or 5 bits
// of fraction. `bits` is 11 or 10. Pixels are rounded by core/simd/store-inl.h, to the same bits.

/// The float equal to an unsigned 11- or 10-bit one; NaN keeps its payload in the top bits.
constexpr float float_from_unsigned(uint32_t code, int bits) { return float_from_half(uint16_t(code << (15 - bits))); }

/// toward_zero or nearest, ties to even; finite values past the largest (65024, 64512) become it under both, negative
/// ones and -infinity 0. NaN becomes the quiet one, 7E0 or 3F0.
constexpr uint32_t unsigned_from_float(float value, int bits, HalfRound round) {
  const uint32_t word = std::bit_cast<uint32_t>(value), infinity = 31u << (bits - 5);
  if ((word & 0x7fffffffu) > 0x7f800000u) return infinity | 1u << (bits - 6);
  if (word == 0x7f800000u) return infinity;
  if ((word & 0x80000000u) != 0) return 0;
  // Truncating twice is truncating once, and both have the exponents of a half.
  const uint32_t below = uint32_t(half_from_float(value, HalfRound::toward_zero)) >> (15 - bits);
  if (round == HalfRound::toward_zero || below + 1 == infinity) return below;
  const double low = double(float_from_unsigned(below, bits)), high = double(float_from_unsigned(below + 1, bits));
  const double past = double(value) - low, rest = high - double(value);  // exact wherever they are nearly equal
  return past > rest || (past == rest && (below & 1u) != 0) ? below + 1 : below;
}

}  // namespace trueshade
