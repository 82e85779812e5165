#include "shading/light/power.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trueshade {
namespace {

constexpr double kSqrtHalf = 0.70710678118654752440, kLn2 = 0.69314718055994530942, kTwoOverLn2 = 2.8853900817779268147;

}  // namespace

double log2_of(double x) {
  uint64_t bits = std::bit_cast<uint64_t>(x);
  int exponent = int(bits >> 52) - 1022;
  double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFull) | 0x3FE0000000000000ull);  // [1/2, 1)
  if (m < kSqrtHalf) {
    m = m * 2.0;
    --exponent;
  }
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double sum = 1.0 / 21.0;
  for (int k = 19; k >= 1; k -= 2) sum = sum * z + 1.0 / double(k);
  return (s * kTwoOverLn2) * sum + double(exponent);
}

double exp2_of(double t) {
  if (t < -1000.0) return 0.0;
  if (t > 1000.0) t = 1000.0;
  const double n = std::nearbyint(t), r = (t - n) * kLn2;
  double sum = 1.0;
  for (int k = 13; k >= 1; --k) sum = sum * (r / double(k)) + 1.0;
  return sum * std::bit_cast<double>(uint64_t(int64_t(n) + 1023) << 52);
}

Exponent exponent_of(float exponent, PowerBase base) {
  const bool integer = exponent <= 8192.0f && exponent == std::nearbyint(exponent);
  if (!integer) return {false, -1, double(exponent)};
  const int whole = int(exponent);
  const bool squared = base == PowerBase::square_if_even && whole % 2 == 0;
  return {squared, squared ? whole / 2 : whole, double(squared ? whole / 2 : whole)};
}

double power(double x, double p) {
  if (x > std::numeric_limits<double>::max()) return x;
  return x > 0.0 ? exp2_of(p * log2_of(x)) : 0.0;
}

}  // namespace trueshade
