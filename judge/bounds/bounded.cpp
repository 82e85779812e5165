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

}  // namespace

double relative_power_error(const Arithmetic& a, double x, double s) {
  const double exponent = std::fabs(std::log2(x));
  return own_error(a, x >= 0.5 && x <= 2, exponent, s * exponent, s);
}

}  // namespace trueshade::oracle
