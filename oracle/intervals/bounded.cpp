#include "oracle/intervals/bounded.h"

namespace trueshade::oracle {

namespace {

/// Relative error of pow(x, s) itself, x exact.
double own_error(const Arithmetic& a, double x, double s) {
  if (a.exact_pow) return 0x1p-24;
  const double exponent = std::log2(x), y = std::fabs(s * exponent), ulp = 0x1p-23;
  const double log2_error = x >= 0.5 && x <= 2 ? 0x1p-21 : 3 * ulp * std::fabs(exponent);
  return std::expm1(std::log(2.0) * (s * log2_error + y * a.roundoff)) + (3 + 2 * y) * ulp;
}

}  // namespace

Bounded power(const Arithmetic& a, const Bounded& x, double s) {
  if (s == 0) return {1, 0};  // x = 0 is the caller's matter: GLSL leaves 0^0 undefined
  if (!(x.high() > 0)) return {0, kSmallestFloat};
  const double high = std::pow(x.high(), s) * (1 + own_error(a, x.high(), s));
  const double value = x.value > 0 ? std::pow(x.value, s) : 0;
  // (1 - d)^s >= 1 - s d for s >= 1; for smaller s the low end is powered itself.
  double low = 0;
  if (x.low() > 0) low = std::pow(x.low(), s) * std::max(0.0, 1 - own_error(a, x.low(), s));
  return {value, std::max(high - value, value - low) + kSmallestFloat};
}

}  // namespace trueshade::oracle
