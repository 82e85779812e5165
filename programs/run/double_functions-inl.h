// Functions that are evaluated in double, operation by operation as docs/arithmetic.md has them, for vectors of
// doubles. Included once per SIMD target.
#if defined(TRUESHADE_PROGRAMS_RUN_DOUBLE_FUNCTIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_PROGRAMS_RUN_DOUBLE_FUNCTIONS_INL_H_
#undef TRUESHADE_PROGRAMS_RUN_DOUBLE_FUNCTIONS_INL_H_
#else
#define TRUESHADE_PROGRAMS_RUN_DOUBLE_FUNCTIONS_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace trueshade::programs::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::ScalableTag<double>;
using DW = hn::RebindToUnsigned<DD>;  // the bits of doubles
using VD = hn::Vec<DD>;
using MD = hn::Mask<DD>;

constexpr double kLn2 = 0.69314718055994530942, kLog2OfE = 1.4426950408889634, kPiD = 3.141592653589793,
                 kHalfPi = 1.5707963267948966;
constexpr double kWholeShift = 0x1.8p52;  // adding it to |x| < 2^51 rounds x to an integer, the low bits of the sum

HWY_INLINE VD number(double x) { return hn::Set(DD(), x); }
HWY_INLINE MD is_negative(VD x) { return hn::Lt(hn::CopySign(number(1.0), x), hn::Zero(DD())); }

/// Section 9's log2; also of 0, infinity, what is negative and NaN.
HWY_INLINE VD log2_of(VD x) {
  const DD d;
  const DW dw;
  const auto bits = hn::BitCast(dw, x);
  const auto fraction = hn::And(bits, hn::Set(dw, 0x000FFFFFFFFFFFFFull));
  VD m = hn::BitCast(d, hn::Or(fraction, hn::Set(dw, 0x3FE0000000000000ull)));
  // The biased exponent as the low bits of 2^52.
  const auto biased = hn::BitCast(d, hn::Or(hn::ShiftRight<52>(bits), hn::Set(dw, 0x4330000000000000ull)));
  VD exponent = hn::Sub(biased, number(0x1p52 + 1022.0));
  const MD low = hn::Lt(m, number(0.70710678118654752440));
  m = hn::IfThenElse(low, hn::Mul(m, number(2.0)), m);
  exponent = hn::IfThenElse(low, hn::Sub(exponent, number(1.0)), exponent);
  const VD s = hn::Div(hn::Sub(m, number(1.0)), hn::Add(m, number(1.0))), z = hn::Mul(s, s);
  VD sum = number(1.0 / 21.0);
  for (int k = 19; k >= 1; k -= 2) sum = hn::Add(hn::Mul(sum, z), number(1.0 / double(k)));
  VD result = hn::Add(hn::Mul(hn::Mul(s, number(2.8853900817779268147)), sum), exponent);
  const double infinity = std::numeric_limits<double>::infinity();
  result = hn::IfThenElse(hn::Eq(x, hn::Zero(d)), number(-infinity), result);
  result = hn::IfThenElse(hn::Eq(x, number(infinity)), x, result);
  return hn::IfThenElse(hn::Ge(x, hn::Zero(d)), result, hn::NaN(d));
}

/// Section 9's exp2; NaN of NaN.
HWY_INLINE VD exp2_of(VD t) {
  const DD d;
  const DW dw;
  const MD none = hn::Lt(t, number(-1000.0));
  t = hn::IfThenElse(none, hn::Zero(d), hn::IfThenElse(hn::Gt(t, number(1000.0)), number(1000.0), t));
  const VD shifted = hn::Add(t, number(kWholeShift)), n = hn::Sub(shifted, number(kWholeShift));
  const VD r = hn::Mul(hn::Sub(t, n), number(kLn2));
  VD sum = number(1.0);
  for (int k = 13; k >= 1; --k) sum = hn::Add(hn::Mul(sum, hn::Div(r, number(double(k)))), number(1.0));
  const auto scale = hn::ShiftLeft<52>(hn::Add(hn::BitCast(dw, shifted), hn::Set(dw, 1023)));
  return hn::IfThenElse(none, hn::Zero(d), hn::Mul(sum, hn::BitCast(d, scale)));
}

/// x^p of an integer p in 0..8192, the same for all lanes.
HWY_INLINE VD integer_power(VD x, int p) {
  if (p == 0) return number(1.0);
  int bit = 1;
  while (2 * bit <= p) bit *= 2;
  VD result = x;
  for (bit /= 2; bit > 0; bit /= 2) {
    result = hn::Mul(result, result);
    if ((p & bit) != 0) result = hn::Mul(result, x);
  }
  return result;
}

/// x^p of an integer p a lane, none with a bit above top_bit. It starts from 1, whose squares are 1.
HWY_INLINE VD integer_power(VD x, VD p, int top_bit) {
  const VD one = number(1.0);
  VD result = one, left = p;  // bits of p not yet used
  for (int bit = top_bit; bit > 0; bit /= 2) {
    const VD weight = number(double(bit));
    const MD set = hn::Ge(left, weight);
    left = hn::IfThenElse(set, hn::Sub(left, weight), left);
    result = hn::Mul(result, result);
    result = hn::IfThenElse(set, hn::Mul(result, x), result);
  }
  return result;
}

/// Lanes of integers that are raised to by binary powering.
HWY_INLINE MD is_whole_power(VD p) {
  const DD d;
  const MD inside = hn::And(hn::Ge(p, hn::Zero(d)), hn::Le(p, number(8192.0)));
  const VD held = hn::IfThenElseZero(inside, p);
  return hn::And(inside, hn::Eq(hn::Sub(hn::Add(held, number(kWholeShift)), number(kWholeShift)), held));
}

HWY_INLINE VD power_of(VD x, VD p) {
  const DD d;
  const MD whole = is_whole_power(p);
  const VD real = hn::AllTrue(d, whole) ? x : exp2_of(hn::Mul(p, log2_of(x)));
  if (hn::AllFalse(d, whole)) return real;
  const VD held = hn::IfThenElseZero(whole, p);
  alignas(64) double lane[hn::MaxLanes(DD())];
  hn::Store(held, d, lane);
  double most = 1.0;
  for (size_t k = 0; k < hn::Lanes(d); ++k) most = lane[k] > most ? lane[k] : most;
  int top_bit = 1;
  while (2 * top_bit <= int(most)) top_bit *= 2;
  return hn::IfThenElse(whole, integer_power(x, held, top_bit), real);
}

/// Sine and cosine by section 1; NaN above 1e6.
struct SineCosine {
  VD sine, cosine;
};

HWY_INLINE VD sine_near_0(VD r) {
  const VD z = hn::Mul(r, r);
  constexpr double kFactorial[] = {1307674368000.0, 6227020800.0, 39916800.0, 362880.0, 5040.0, 120.0, 6.0, 1.0};
  VD p = number(1.0 / 355687428096000.0);
  double sign = -1.0;
  for (const double factorial : kFactorial) {
    p = hn::Add(hn::Mul(p, z), number(sign / factorial));
    sign = -sign;
  }
  return hn::Mul(p, r);
}

HWY_INLINE VD cosine_near_0(VD r) {
  const VD z = hn::Mul(r, r);
  constexpr double kFactorial[] = {87178291200.0, 479001600.0, 3628800.0, 40320.0, 720.0, 24.0, 2.0, 1.0};
  VD p = number(1.0 / 20922789888000.0);
  double sign = -1.0;
  for (const double factorial : kFactorial) {
    p = hn::Add(hn::Mul(p, z), number(sign / factorial));
    sign = -sign;
  }
  return p;
}

/// The integer next to x, halves away from zero.
HWY_INLINE VD rounded_away(VD x) {
  const VD whole = hn::Sub(hn::Add(x, number(kWholeShift)), number(kWholeShift));  // halves to even
  const MD lost_half = hn::Eq(hn::Abs(hn::Sub(x, whole)), number(0.5));
  const MD toward_0 = hn::And(lost_half, hn::Lt(hn::Abs(whole), hn::Abs(x)));
  return hn::IfThenElse(toward_0, hn::Add(whole, hn::CopySign(number(1.0), x)), whole);
}

HWY_INLINE SineCosine sine_cosine(VD x) {
  const DD d;
  const DW dw;
  const MD near = hn::Le(hn::Abs(x), number(1e6));
  x = hn::IfThenElse(near, x, hn::NaN(d));
  const VD n = rounded_away(hn::Mul(x, number(2.0 / 3.14159265358979323846)));
  const VD rest =
      hn::Sub(hn::Sub(x, hn::Mul(n, number(1.5707963267341256))), hn::Mul(n, number(6.077100506506192e-11)));
  const auto quadrant = hn::BitCast(dw, hn::Add(n, number(kWholeShift)));
  const auto zero = hn::Zero(dw);
  const auto odd = hn::RebindMask(d, hn::Ne(hn::And(quadrant, hn::Set(dw, 1)), zero));
  const auto second = hn::RebindMask(d, hn::Ne(hn::And(quadrant, hn::Set(dw, 2)), zero));
  const VD s = sine_near_0(rest), c = cosine_near_0(rest);
  const VD sine = hn::IfThenElse(odd, c, s), cosine = hn::IfThenElse(odd, s, c);
  const MD turned = hn::Xor(odd, second);  // quadrants 1 and 2
  SineCosine out;
  out.sine = hn::IfThenElse(second, hn::Neg(sine), sine);
  out.sine = hn::IfThenElse(hn::Eq(x, hn::Zero(d)), x, out.sine);
  out.cosine = hn::IfThenElse(turned, hn::Neg(cosine), cosine);
  return out;
}

/// The arc tangent: two halvings of the angle, then the series.
HWY_INLINE VD atan_of(VD x) {
  const VD a = hn::Abs(x), one = number(1.0);
  const MD big = hn::Gt(a, one);
  VD t = hn::IfThenElse(big, hn::Div(one, a), a);
  for (int i = 0; i < 2; ++i) t = hn::Div(t, hn::Add(one, hn::Sqrt(hn::Add(one, hn::Mul(t, t)))));
  const VD z = hn::Mul(t, t);
  VD c = number(1.0 / 21.0);
  for (int k = 19; k >= 1; k -= 2) c = hn::Sub(number(1.0 / double(k)), hn::Mul(z, c));
  VD p = hn::Mul(number(4.0), hn::Mul(t, c));
  p = hn::IfThenElse(big, hn::Sub(number(kHalfPi), p), p);
  return hn::CopySign(p, x);
}

HWY_INLINE VD atan2_of(VD y, VD x) {
  const DD d;
  const VD zero = hn::Zero(d), infinity = number(std::numeric_limits<double>::infinity());
  const VD high = hn::Abs(y), wide = hn::Abs(x);
  VD q = hn::Div(high, wide);
  q = hn::IfThenElse(hn::And(hn::Eq(high, zero), hn::Eq(wide, zero)), zero, q);
  q = hn::IfThenElse(hn::And(hn::Eq(high, infinity), hn::Eq(wide, infinity)), number(1.0), q);
  VD p = atan_of(q);
  p = hn::IfThenElse(is_negative(x), hn::Sub(number(kPiD), p), p);
  return hn::CopySign(p, y);
}

HWY_INLINE VD asin_of(VD x) {
  const VD one = number(1.0), q = hn::Sqrt(hn::Mul(hn::Sub(one, x), hn::Add(one, x)));
  return hn::IfThenElse(hn::Gt(hn::Abs(x), one), hn::NaN(DD()), atan_of(hn::Div(x, q)));
}

HWY_INLINE VD acos_of(VD x) {
  const VD one = number(1.0), q = hn::Sqrt(hn::Mul(hn::Sub(one, x), hn::Add(one, x)));
  const VD p = atan_of(hn::Div(q, hn::Abs(x)));
  const VD result = hn::IfThenElse(hn::Lt(x, hn::Zero(DD())), hn::Sub(number(kPiD), p), p);
  return hn::IfThenElse(hn::Gt(hn::Abs(x), one), hn::NaN(DD()), result);
}

/// Below 2^-8 hyperbolic functions are x + x^3 / `divisor`. They have the sign of x, also where x is 0.
HWY_INLINE VD with_cubic(VD x, double divisor, VD elsewhere) {
  const VD cube = hn::Mul(hn::Mul(x, x), x);
  const VD small = hn::Add(x, hn::Div(cube, number(divisor)));
  return hn::CopySign(hn::IfThenElse(hn::Lt(hn::Abs(x), number(0x1p-8)), small, elsewhere), x);
}
HWY_INLINE VD exp_of_size(VD x) { return exp2_of(hn::Mul(hn::Abs(x), number(kLog2OfE))); }

HWY_INLINE VD sinh_of(VD x) {
  const VD e = exp_of_size(x), half = number(0.5);
  return with_cubic(x, 6.0, hn::Mul(hn::Sub(e, hn::Div(number(1.0), e)), half));
}
HWY_INLINE VD cosh_of(VD x) {
  const VD e = exp_of_size(x);
  return hn::Mul(hn::Add(e, hn::Div(number(1.0), e)), number(0.5));
}
HWY_INLINE VD tanh_of(VD x) {
  const VD e = exp_of_size(x), r = hn::Div(number(1.0), e);
  const VD quotient = hn::Div(hn::Sub(e, r), hn::Add(e, r));
  return with_cubic(x, -3.0, hn::IfThenElse(hn::Gt(hn::Abs(x), number(20.0)), number(1.0), quotient));
}
HWY_INLINE VD asinh_of(VD x) {
  const VD root = hn::Sqrt(hn::Add(hn::Mul(x, x), number(1.0)));
  return with_cubic(x, -6.0, hn::Mul(log2_of(hn::Add(hn::Abs(x), root)), number(kLn2)));
}
HWY_INLINE VD acosh_of(VD x) {
  const VD one = number(1.0), root = hn::Sqrt(hn::Sub(hn::Mul(x, x), one));
  const VD result = hn::Mul(log2_of(hn::Add(x, root)), number(kLn2));
  return hn::IfThenElse(hn::Lt(x, one), hn::NaN(DD()), result);
}
HWY_INLINE VD atanh_of(VD x) {
  const VD a = hn::Abs(x), one = number(1.0);
  const VD quotient = hn::Div(hn::Add(one, a), hn::Sub(one, a));
  const VD result = hn::Mul(number(0.5), hn::Mul(log2_of(quotient), number(kLn2)));
  return with_cubic(x, 3.0, result);
}

}  // namespace trueshade::programs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
