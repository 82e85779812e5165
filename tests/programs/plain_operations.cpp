#include "tests/programs/plain_operations.h"

#include <bit>
#include <cmath>
#include <limits>

namespace trueshade::programs {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLn2Plain = 0.6931471805599453, kLog2EPlain = 1.4426950408889634;

float f(uint32_t x) { return std::bit_cast<float>(x); }
uint32_t u(float x) { return std::bit_cast<uint32_t>(x); }
int32_t i(uint32_t x) { return int32_t(x); }

double plain_log2(double x) {
  if (!(x >= 0)) return kNan;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.7071067811865476) m *= 2, --exponent;
  const double s = (m - 1) / (m + 1), z = s * s;
  double sum = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) sum = sum * z + 1.0 / k;
  return (s * (2 / kLn2Plain)) * sum + exponent;
}

double plain_exp2(double t) {
  if (t != t) return t;
  if (t < -1000) return 0;
  if (t > 1000) t = 1000;
  const double n = std::nearbyint(t), r = (t - n) * kLn2Plain;
  double e = 1;
  for (int k = 13; k >= 1; --k) e = e * (r / k) + 1;
  return std::ldexp(e, int(n));
}

double plain_pow(float x, float y) {
  if (!(y >= 0 && y <= 8192 && y == std::floor(y))) return plain_exp2(double(y) * plain_log2(double(x)));
  const int p = int(y);
  double result = 1;
  for (int bit = 8192; bit > 0; bit /= 2) {
    result = result * result;
    if ((p & bit) != 0) result = result * double(x);
  }
  return result;
}

/// Section 1: which of sine and cosine, 0 or 1 quadrants on.
double plain_wave(double x, int quadrants) {
  if (!(std::abs(x) <= 1e6)) return kNan;
  const double n = std::round(x * (2 / 3.141592653589793)),
               r = (x - n * 1.5707963267341256) - n * 6.077100506506192e-11;
  const int quadrant = int((static_cast<long long>(n) + quadrants) & 3);
  const double z = r * r;
  double factorial = 1, sum = 0, terms[18];
  for (int k = 1; k <= 17; ++k) factorial *= k, terms[k] = (k / 2 % 2 == 0 ? 1 : -1) / factorial;
  terms[0] = 1;
  if (quadrant % 2 == 0) {
    sum = terms[17];
    for (int k = 15; k >= 1; k -= 2) sum = sum * z + terms[k];
    sum = sum * r;
  } else {
    sum = terms[16];
    for (int k = 14; k >= 0; k -= 2) sum = sum * z + terms[k];
  }
  return quadrant >= 2 ? -sum : sum;
}
double plain_sin(double x) { return x == 0 ? x : plain_wave(x, 0); }
double plain_cos(double x) { return plain_wave(x, 1); }

double plain_atan(double x) {
  const double a = std::abs(x);
  double t = a > 1 ? 1 / a : a;
  for (int k = 0; k < 2; ++k) t = t / (1 + std::sqrt(1 + t * t));
  const double z = t * t;
  double c = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) c = 1.0 / k - z * c;
  double p = 4 * (t * c);
  if (a > 1) p = 1.5707963267948966 - p;
  return std::copysign(p, x);
}

double plain_atan2(double y, double x) {
  if (y != y || x != x) return kNan;
  double q = std::abs(y) / std::abs(x);
  if (y == 0 && x == 0) q = 0;
  if (std::isinf(y) && std::isinf(x)) q = 1;
  double p = plain_atan(q);
  if (std::signbit(x)) p = 3.141592653589793 - p;
  return std::copysign(p, y);
}

double plain_hyperbolic(Op op, double x) {
  const double a = std::abs(x), cube = (x * x) * x;
  const bool small = a < 0x1p-8;
  const double e = plain_exp2(a * kLog2EPlain);
  if (x == 0 && op != Op::cosh && op != Op::acosh) return x;  // the sign of a zero stays
  switch (op) {
    case Op::sinh:
      return small ? x + cube / 6 : std::copysign((e - 1 / e) * 0.5, x);
    case Op::cosh:
      return (e + 1 / e) * 0.5;
    case Op::tanh:
      return small ? x - cube / 3 : std::copysign(a > 20 ? 1 : (e - 1 / e) / (e + 1 / e), x);
    case Op::asinh:
      return small ? x - cube / 6 : std::copysign(plain_log2(a + std::sqrt(x * x + 1)) * kLn2Plain, x);
    case Op::acosh:
      return x < 1 ? kNan : plain_log2(x + std::sqrt(x * x - 1)) * kLn2Plain;
    default:  // atanh
      if (a > 1) return kNan;
      return small ? x + cube / 3 : std::copysign(0.5 * (plain_log2((1 + a) / (1 - a)) * kLn2Plain), x);
  }
}

double plain_function(Op op, float a, float b) {
  const double x = double(a), root = std::sqrt((1 - x) * (1 + x));
  switch (op) {
    case Op::exp:
      return plain_exp2(x * kLog2EPlain);
    case Op::exp2:
      return plain_exp2(x);
    case Op::log:
      return plain_log2(x) * kLn2Plain;
    case Op::log2:
      return plain_log2(x);
    case Op::pow:
      return plain_pow(a, b);
    case Op::sin:
      return plain_sin(x);
    case Op::cos:
      return plain_cos(x);
    case Op::tan:
      return plain_sin(x) / plain_cos(x);
    case Op::asin:
      return std::abs(x) > 1 ? kNan : plain_atan(x / root);
    case Op::acos: {
      if (std::abs(x) > 1) return kNan;
      const double p = plain_atan(root / std::abs(x));
      return x < 0 ? 3.141592653589793 - p : p;
    }
    case Op::atan:
      return plain_atan(x);
    case Op::atan2:
      return plain_atan2(x, double(b));
    default:
      return plain_hyperbolic(op, x);
  }
}

uint32_t plain_float(Op op, float a, float b, float c) {
  switch (op) {
    case Op::f_add:
      return u(a + b);
    case Op::f_sub:
      return u(a - b);
    case Op::f_mul:
      return u(a * b);
    case Op::f_div:
      return u(a / b);
    case Op::f_sqrt:
      return u(std::sqrt(a));
    case Op::f_inverse_sqrt:
      return u(1.0f / std::sqrt(a));
    case Op::f_fma:
      return u(std::fma(a, b, c));
    case Op::f_floor:
      return u(std::floor(a));
    case Op::f_ceil:
      return u(std::ceil(a));
    case Op::f_trunc:
      return u(std::trunc(a));
    case Op::f_round:
      return u(std::nearbyint(a));
    case Op::f_min:
      return u(a < b ? a : b);
    case Op::f_max:
      return u(a > b ? a : b);
    case Op::f_eq:
      return a == b;
    case Op::f_ne:
      return a != b;
    case Op::f_lt:
      return a < b;
    case Op::f_le:
      return a <= b;
    case Op::f_to_i:
      return a != a ? 0u : a >= 2147483648.0f ? 2147483647u : a <= -2147483648.0f ? 0x80000000u : uint32_t(int32_t(a));
    case Op::f_to_u:
      return a != a || a <= 0 ? 0u : a >= 4294967296.0f ? ~0u : uint32_t(a);
    case Op::f_bits:
      return a != a ? 0x7FC00000u : u(a);
    case Op::f_significand: {
      int exponent = 0;
      return a == 0 || !std::isfinite(a) ? u(a) : u(std::frexp(a, &exponent));
    }
    case Op::f_exponent: {
      int exponent = 0;
      if (a != 0 && std::isfinite(a)) static_cast<void>(std::frexp(a, &exponent));
      return uint32_t(exponent);
    }
    default:
      return u(float(plain_function(op, a, b)));
  }
}

/// A float as half, by the exact multiple of the half's unit that is nearest.
uint32_t plain_half(float x) {
  if (x != x) return 0x7E00;
  const uint32_t sign = std::signbit(x) ? 0x8000 : 0;
  const double size = std::abs(double(x));
  if (size == 0) return sign;
  if (size >= 65520) return sign | 0x7C00;
  int exponent = 0;
  static_cast<void>(std::frexp(size, &exponent));
  const int unit = std::max(exponent - 11, -24);
  const double code = std::nearbyint(std::ldexp(size, -unit));  // of 11 bits, the first of which is not stored
  return sign | (uint32_t(unit + 24) * 1024 + uint32_t(code));
}

float plain_from_half(uint32_t h) {
  const uint32_t exponent = h >> 10 & 31, fraction = h & 1023;
  const double size = exponent == 31  ? (fraction == 0 ? kInfinity : kNan)
                      : exponent == 0 ? std::ldexp(double(fraction), -24)
                                      : std::ldexp(double(1024 + fraction), int(exponent) - 25);
  return float((h & 0x8000) != 0 ? -size : size);
}

int bit_number(uint32_t a, bool highest) {
  for (int k = 0; k < 32; ++k)
    if ((a >> (highest ? 31 - k : k) & 1) != 0) return highest ? 31 - k : k;
  return -1;
}

}  // namespace

uint32_t plain(Op op, uint32_t a, uint32_t b, uint32_t c) {
  switch (op) {
    case Op::f_neg:
      return a ^ 0x80000000u;
    case Op::f_abs:
      return a & 0x7FFFFFFFu;
    case Op::i_to_f:
      return u(float(i(a)));
    case Op::u_to_f:
      return u(float(a));
    case Op::f_from_bits:
      return a;
    case Op::f_to_half:
      return plain_half(f(a));
    case Op::f_from_half:
      return u(plain_from_half(a & 0xFFFF));
    case Op::select:
      return a != 0 ? b : c;
    case Op::b_and:
      return a & b;
    case Op::b_or:
      return a | b;
    case Op::b_xor:
      return a ^ b;
    case Op::b_not:
      return 1 - a;
    case Op::i_add:
      return a + b;
    case Op::i_sub:
      return a - b;
    case Op::i_mul:
      return a * b;
    case Op::i_mul_high:
      return uint32_t((int64_t(i(a)) * i(b)) >> 32);
    case Op::u_mul_high:
      return uint32_t(uint64_t(a) * b >> 32);
    case Op::i_div:
      return b == 0 ? 0u : uint32_t(int64_t(i(a)) / i(b));
    case Op::u_div:
      return b == 0 ? 0u : a / b;
    case Op::i_rem:
      return b == 0 ? 0u : uint32_t(int64_t(i(a)) % i(b));
    case Op::u_rem:
      return b == 0 ? 0u : a % b;
    case Op::i_and:
      return a & b;
    case Op::i_or:
      return a | b;
    case Op::i_xor:
      return a ^ b;
    case Op::i_not:
      return ~a;
    case Op::i_shl:
      return a << (b % 32);
    case Op::i_shr:
      return uint32_t(int64_t(i(a)) >> (b % 32));
    case Op::u_shr:
      return a >> (b % 32);
    case Op::i_eq:
      return a == b;
    case Op::i_lt:
      return i(a) < i(b);
    case Op::u_lt:
      return a < b;
    case Op::bit_count: {
      uint32_t count = 0;
      for (int k = 0; k < 32; ++k) count += a >> k & 1;
      return count;
    }
    case Op::bit_reverse: {
      uint32_t out = 0;
      for (int k = 0; k < 32; ++k) out |= (a >> k & 1) << (31 - k);
      return out;
    }
    case Op::lowest_bit:
      return uint32_t(bit_number(a, false));
    case Op::highest_bit:
      return uint32_t(bit_number(a, true));
    case Op::ldexp: {
      const int n = i(b) < -300 ? -300 : i(b) > 300 ? 300 : i(b);
      return u(float(std::ldexp(double(f(a)), n)));
    }
    default:
      return plain_float(op, f(a), f(b), f(c));
  }
}

}  // namespace trueshade::programs
