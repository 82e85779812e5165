#pragma once
// Numbers as an unknown but legal float32 arithmetic may compute them: the real value and how far off the computed one
// can be. The propagation rule of docs/gl_rules.md section 6, whose per-operation errors are those of GLSL 4.60, 4.7.1.
#include <algorithm>
#include <array>
#include <cmath>

namespace trueshade::oracle {

/// Bounds on the relative error of one operation, for one kind of float arithmetic. The defaults are GLSL's (GLSL 4.60,
/// 4.7.1): + - * are correctly rounded in an undefined rounding mode, hence one ulp = 2^-23; a / b 2.5 ulp; inversesqrt
/// 2 ulp; sqrt is 1 / inversesqrt.
struct Arithmetic {
  double roundoff = 0x1p-23;  ///< of + - *
  double divide = 2.5 * 0x1p-23;
  double inverse_sqrt = 2 * 0x1p-23;
  double square_root = 4.5 * 0x1p-23;
  bool exact_pow = false;  ///< pow() is computed in double and rounded once (docs/arithmetic.md section 9)
  bool wgsl = false;       ///< WGSL's rules hold too where they promise less than GLSL's

  /// How many ulps beyond GLSL's bound exp2 and log2 may err: the WebGPU CTS measures from either float neighbour of
  /// the real result.
  double more_ulps() const { return wgsl ? 1 : 0; }
};

/// The relative error of WGSL's `v / length(v)` beyond that of GLSL's `v * inversesqrt(dot(v, v))`: a root's and a
/// division's errors in place of an inverse root's and a product's. 0 unless `a.wgsl`.
inline double normalize_error(const Arithmetic& a) {
  return a.wgsl ? 1.01 * (a.square_root + a.divide - a.inverse_sqrt) : 0;
}

/// The smallest normal float, 2^-126. An implementation may flush any smaller result to zero.
inline constexpr double kSmallestFloat = 0x1p-126;

/// The result `value` of real arithmetic, and a bound `error` on |computed float - value|; infinite where nothing is
/// known.
struct Bounded {
  double value = 0, error = 0;
  /// The least number that may have been computed.
  double low() const { return value - error; }
  /// The greatest number that may have been computed.
  double high() const { return value + error; }
};
using Bounded3 = std::array<Bounded, 3>;

/// `value` with the error that its operands hand on, and one rounding more, of relative error `relative`.
inline Bounded rounded(double value, double error, double relative) {
  return {value, error + relative * (std::fabs(value) + error) + kSmallestFloat};
}

/// x - y, rounded once, with the bound on its error.
inline Bounded difference(const Arithmetic& a, const Bounded& x, const Bounded& y) {
  return rounded(x.value - y.value, x.error + y.error, a.roundoff);
}
/// x y, rounded once. The error is infinite where that of a factor is, even if the other factor is 0.
inline Bounded product(const Arithmetic& a, const Bounded& x, const Bounded& y) {
  const double error = std::fabs(x.value) * y.error + std::fabs(y.value) * x.error + x.error * y.error;
  return rounded(x.value * y.value, error >= 0 ? error : HUGE_VAL, a.roundoff);
}

/// x / y. The error follows from |x/y - (x+dx)/(y+dy)| <= (dx + |x/y| dy) / (|y| - dy); infinite where y may be 0.
inline Bounded quotient(const Arithmetic& a, const Bounded& x, const Bounded& y) {
  const double room = std::fabs(y.value) - y.error;
  if (!(room > 0)) return {0, HUGE_VAL};
  const double q = x.value / y.value;
  return rounded(q, (x.error + std::fabs(q) * y.error) / room, a.divide);
}

/// The inner product: three products and two sums in any order, fused (FMA) or not. A product passes at most three
/// roundings.
inline Bounded dot(const Arithmetic& a, const Bounded3& x, const Bounded3& y) {
  Bounded r;
  double magnitude = 0;
  for (size_t k = 0; k < 3; ++k) {
    r.value += x[k].value * y[k].value;
    r.error += std::fabs(x[k].value) * y[k].error + std::fabs(y[k].value) * x[k].error + x[k].error * y[k].error;
    magnitude += std::fabs(x[k].value * y[k].value);
  }
  r.error += 3 * a.roundoff * (magnitude + r.error) + 3 * kSmallestFloat;
  return r;
}

/// 1 / sqrt(x) of an x that is not below 0. The error follows from the derivative -x^(-3/2) / 2, which is largest at
/// the low end; infinite where x may be 0.
inline Bounded inverse_sqrt(const Arithmetic& a, const Bounded& x) {
  if (!(x.low() > 0)) return {x.value > 0 ? 1 / std::sqrt(x.value) : 0, HUGE_VAL};
  const double low_root = std::sqrt(x.low());
  return rounded(1 / std::sqrt(x.value), x.error / (2 * x.low() * low_root), a.inverse_sqrt);
}

/// sqrt(x) of an x that is not below 0. The error follows from |sqrt(x+e) - sqrt(x)| <= min(e / sqrt(x), sqrt(e)).
inline Bounded square_root(const Arithmetic& a, const Bounded& x) {
  const double root = std::sqrt(std::max(0.0, x.value));
  const double inherited = root > 0 ? std::min(x.error / root, std::sqrt(x.error)) : std::sqrt(x.error);
  return rounded(root, inherited, a.square_root);
}

/// A bound on the relative error of pow(x, s) = exp2(s * log2 x), for an x > 0 that is exact. log2 errs by 3 ulp
/// outside [0.5, 2], by 2^-21 inside; the product by one rounding; exp2 by 3 + 2|y| ulp, y = s log2 x (GLSL 4.60,
/// 4.7.1). With exact_pow it is one rounding.
double relative_power_error(const Arithmetic& a, double x, double s);

}  // namespace trueshade::oracle
