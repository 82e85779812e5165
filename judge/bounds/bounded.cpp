#include "judge/bounds/bounded.h"

#include <limits>

namespace trueshade::oracle {

namespace {

/// Relative error of pow(x, s) itself, x exact, |log2 x| = exponent, |s log2 x| = y.
double own_error(const Arithmetic& a, bool near_one, double exponent, double y, double s) {
  if (a.exact_pow) return 0x1p-24;
  const double ulp = 0x1p-23, more = a.more_ulps() * ulp;
  const double log2_error = (near_one ? 0x1p-21 : 3 * ulp * exponent) + more * exponent;
  return std::expm1(std::log(2.0) * (s * log2_error + y * a.roundoff)) + (3 + 2 * y) * ulp + more;
}

/// x^s where x is not known to a good part of itself: both ends powered.
Bounded power_of_ends(const Arithmetic& a, double low, double x, double high, double s) {
  const auto error_at = [&](double v) { return relative_power_error(a, v, s); };
  const double top = std::pow(high, s) * (1 + error_at(high)), value = x > 0 ? std::pow(x, s) : 0;
  const double bottom = low > 0 ? std::pow(low, s) * std::max(0.0, 1 - error_at(low)) : 0;
  return {value, std::max(top - value, value - bottom) + kSmallestFloat};
}

/// A driver's exp2 has no accuracy beyond the largest float: lavapipe's 1.8^8192 is no infinity.
Bounded within_floats(const Arithmetic& a, const Bounded& x) {
  if (a.exact_pow || x.high() <= double(std::numeric_limits<float>::max())) return x;
  return {std::min(x.value, double(std::numeric_limits<float>::max())), HUGE_VAL};
}

}  // namespace

double relative_power_error(const Arithmetic& a, double x, double s) {
  const double exponent = std::fabs(std::log2(x));
  return own_error(a, x >= 0.5 && x <= 2, exponent, s * exponent, s);
}

Bounded power(const Arithmetic& a, double low, double x, double high, double s) {
  if (a.wgsl && !(low >= kSmallestFloat)) return {x > 0 ? std::pow(x, s) : 0, HUGE_VAL};  // log2 of none is open
  if (s == 0) return {1, 0};  // x = 0 is the caller's matter: GLSL leaves 0^0 undefined
  if (!(high > 0)) return {0, kSmallestFloat};
  const double r = low > 0 ? std::max(high - x, x - low) / low : HUGE_VAL, t = s * r;
  if (!(t < 0.5)) return within_floats(a, power_of_ends(a, low, x, high, s));
  // (1 + r)^s <= e^t <= 1 + t + t^2 for t <= 1, and 1 - (1 - r)^s <= t for r as divided by the low end.
  const double log2_x = std::log2(x), exponent = std::fabs(log2_x) + 2 * r;
  const double value = std::exp2(s * log2_x);
  const double own = own_error(a, low >= 0.5 && high <= 2, exponent, s * exponent, s);
  const double relative = (t + t * t) * (1 + own) + own + 0x1p-45 * (1 + s * exponent);
  return within_floats(a, {value, value * relative + kSmallestFloat});
}

}  // namespace trueshade::oracle
