#include "raster/triangles/snap.h"

#include <bit>
#include <cmath>

#include "raster/fixed_point.h"

namespace trueshade {
namespace {

using Wide = __int128;

// Sign of x * a - w * b, exact: mantissas of 53 bits times factors below 2^42, in 128-bit integers. The caller asks
// only where both products are close, so their exponents differ by less than the factors' range.
int compare_products(double x, int64_t a, double w, int64_t b) {
  int x_exponent = 0, w_exponent = 0;
  Wide left = Wide(int64_t(std::ldexp(std::frexp(x, &x_exponent), 53))) * a;
  Wide right = Wide(int64_t(std::ldexp(std::frexp(w, &w_exponent), 53))) * b;
  if (left == 0 || right == 0 || (left < 0) != (right < 0)) return (left > right) - (left < right);
  const auto magnitude_bits = [](Wide v) {
    int bits = 0;
    for (unsigned __int128 m = v < 0 ? static_cast<unsigned __int128>(-v) : static_cast<unsigned __int128>(v); m != 0;
         m >>= 1)
      ++bits;
    return bits;
  };
  const int sign = left < 0 ? -1 : 1;
  const int left_top = magnitude_bits(left) + x_exponent, right_top = magnitude_bits(right) + w_exponent;
  if (left_top != right_top) return left_top > right_top ? sign : -sign;
  const int shift = x_exponent - w_exponent;  // equal tops: the shifted operand ends as long as the other
  if (shift > 0) left <<= shift;
  if (shift < 0) right <<= -shift;
  return (left > right) - (left < right);
}

// fl32(a * b + c), rounded once. The product is exact in a double; the sum is rounded to odd, which a second rounding
// to 24 bits does not disturb (Boldo and Melquiond, "Emulation of a FMA and correctly rounded sums", 2008).
float fused_multiply_add(float a, float b, float c) {
  const double product = double(a) * double(b), sum = product + double(c);
  const double c_part = sum - product, error = (product - (sum - c_part)) + (double(c) - c_part);
  const uint64_t bits = std::bit_cast<uint64_t>(sum);
  if (error == 0.0 || error != error || (bits & 1) != 0) return float(sum);
  return float(std::bit_cast<double>((error > 0.0) == (sum > 0.0) ? bits + 1 : bits - 1));
}

}  // namespace

std::optional<int64_t> float_snapped(const WindowTransform& t, int axis, float coordinate, float w) {
  const float pixels = fused_multiply_add(coordinate * (1.0f / w), t.half_size[axis], t.center[axis]);
  const double from_center = double((pixels - 0.5f) * 256.0f);
  if (!(std::abs(from_center) < double(kWideLimit))) return std::nullopt;
  return int64_t(std::nearbyint(from_center)) + 128 - 256 * t.corner[axis];
}

std::optional<int64_t> snapped_quotient(double x, double w, int64_t scale) {
  const double estimate = (x / w) * double(scale);
  if (!(std::abs(estimate) < double(kWideLimit))) return std::nullopt;
  const double nearest = std::nearbyint(estimate);
  int64_t n = int64_t(nearest);
  // Below 2^40 the estimate is off by less than 2^-11: away from a tie it has decided.
  if (std::abs(estimate - nearest) < 0.5 - 0x1p-10) return n;
  // n is right if |2 x scale - 2 n w| <= w, with n even where equal. The estimate is at most one off.
  for (;;) {
    const int above = compare_products(x, 2 * scale, w, 2 * n + 1);
    if (above > 0 || (above == 0 && n % 2 != 0)) {
      ++n;
      continue;
    }
    const int below = compare_products(x, 2 * scale, w, 2 * n - 1);
    if (below < 0 || (below == 0 && n % 2 != 0)) {
      --n;
      continue;
    }
    return n;
  }
}

}  // namespace trueshade
