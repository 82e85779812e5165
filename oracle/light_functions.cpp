#include "oracle/light_functions.h"

#include <cmath>
#include <limits>

namespace trueshade::oracle::glsl {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.141592653589793, kHalfPi = 1.5707963267948966;
constexpr double kLn2 = 0.6931471805599453, kLog2E = 1.4426950408889634;
constexpr double kSeriesBelow = 0x1p-8;  ///< where hyperbolic functions are two terms of a series

/// `magnitude`, 0 or more, with the sign of x.
double signed_as(double magnitude, double x) { return std::signbit(x) ? -magnitude : magnitude; }

double factorial(int k) {
  double product = 1;
  for (int i = 2; i <= k; ++i) product *= i;
  return product;
}

struct Turned {
  double sine, cosine;
};

/// 1/first! - z/(first + 2)! + ... to the last, from the highest term down.
double taylor(double z, int first, int last) {
  double sum = 0;
  for (int k = last; k >= first; k -= 2) sum = sum * z + ((k - first) / 2 % 2 == 0 ? 1 : -1) * (1 / factorial(k));
  return sum;
}

Turned turned(double x) {
  if (!(std::fabs(x) <= 1e6)) return {kNaN, kNaN};
  const double n = std::round(x * (2 / kPi));
  const double r = (x - n * 1.5707963267341256) - n * 6.077100506506192e-11, z = r * r;
  const double s = taylor(z, 1, 17) * r, c = taylor(z, 0, 16);
  switch (int(n) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double integer_power(double x, int p) {
  if (p == 0) return 1;
  int bit = 1 << 13;
  while ((p & bit) == 0) bit >>= 1;
  double result = x;
  for (bit >>= 1; bit > 0; bit >>= 1) {
    result = result * result;
    if ((p & bit) != 0) result = result * x;
  }
  return result;
}

double exp_of_magnitude(double x) { return exp2_64(std::fabs(x) * kLog2E); }

double cube(double x) { return (x * x) * x; }

}  // namespace

double log2_of_positive(double x) {
  if (std::isinf(x) || std::isnan(x)) return x;
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < 0.7071067811865476) m = m * 2, e = e - 1;
  const double s = (m - 1) / (m + 1), z = s * s;
  double sum = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) sum = sum * z + 1.0 / k;
  return (s * (2 / kLn2)) * sum + e;
}

double log2_64(float x) {
  if (x == 0) return -kInfinite;
  if (!(x > 0)) return kNaN;
  return log2_of_positive(x);
}

double exp2_64(double t) {
  if (std::isnan(t)) return kNaN;
  if (t < -1000) return 0;
  if (t > 1000) t = 1000;
  const double n = std::round(t), r = (t - n) * kLn2;
  double e = 1;
  for (int k = 13; k >= 1; --k) e = e * (r / k) + 1;
  return std::ldexp(e, int(n));
}

double atan_64(double x) {
  if (std::isnan(x)) return kNaN;
  const double a = std::fabs(x);
  double t = a > 1 ? 1 / a : a;
  t = t / (1 + std::sqrt(1 + t * t));
  t = t / (1 + std::sqrt(1 + t * t));
  const double z = t * t;
  double c = 1.0 / 21;
  for (int k = 19; k >= 1; k -= 2) c = 1.0 / k - z * c;
  double p = 4 * (t * c);
  if (a > 1) p = kHalfPi - p;
  return signed_as(p, x);
}

float log2(float x) { return float(log2_64(x)); }
float log(float x) { return float(log2_64(x) * kLn2); }
float exp2(float x) { return float(exp2_64(x)); }
float exp(float x) { return float(exp2_64(x * kLog2E)); }

float pow(float x, float y) {
  if (y >= 0 && y <= 8192 && y == std::floor(y)) return float(integer_power(x, int(y)));
  return float(exp2_64(y * log2_64(x)));
}

float sin(float x) { return x == 0 ? x : float(turned(x).sine); }
float cos(float x) { return float(turned(x).cosine); }

float tan(float x) {
  if (x == 0) return x;
  const Turned at = turned(x);
  return float(at.sine / at.cosine);
}

float asin(float x) {
  if (std::fabs(x) > 1) return float(kNaN);
  const double q = std::sqrt((1 - double(x)) * (1 + double(x)));
  return float(atan_64(x / q));
}

float acos(float x) {
  if (std::fabs(x) > 1) return float(kNaN);
  const double q = std::sqrt((1 - double(x)) * (1 + double(x)));
  const double p = atan_64(q / std::fabs(double(x)));
  return float(x < 0 ? kPi - p : p);
}

float atan(float x) { return float(atan_64(x)); }

float atan2(float y, float x) {
  if (std::isnan(y) || std::isnan(x)) return float(kNaN);
  double up = std::fabs(double(y)), along = std::fabs(double(x));
  if (up == 0 && along == 0) return float(signed_as(std::signbit(x) ? kPi : 0, y));
  if (std::isinf(up) && std::isinf(along)) up = along = 1;
  double p = atan_64(up / along);
  if (std::signbit(x)) p = kPi - p;
  return float(signed_as(p, y));
}

float sinh(float x) {
  if (std::fabs(x) < kSeriesBelow) return x == 0 ? x : float(x + cube(x) / 6);
  const double e = exp_of_magnitude(x);
  return float(signed_as((e - 1 / e) * 0.5, x));
}

float cosh(float x) {
  const double e = exp_of_magnitude(x);
  return float((e + 1 / e) * 0.5);
}

float tanh(float x) {
  const double a = std::fabs(x);
  if (a < kSeriesBelow) return x == 0 ? x : float(x - cube(x) / 3);
  if (a > 20) return float(signed_as(1, x));
  const double e = exp_of_magnitude(x);
  return float(signed_as((e - 1 / e) / (e + 1 / e), x));
}

float asinh(float x) {
  const double a = std::fabs(x);
  if (a < kSeriesBelow) return x == 0 ? x : float(x - cube(x) / 6);
  return float(signed_as(log2_of_positive(a + std::sqrt(a * a + 1)) * kLn2, x));
}

float acosh(float x) {
  const double d = x;
  if (x < 1) return float(kNaN);
  return float(log2_of_positive(d + std::sqrt(d * d - 1)) * kLn2);
}

float atanh(float x) {
  const double a = std::fabs(x);
  if (a > 1) return float(kNaN);
  if (a < kSeriesBelow) return x == 0 ? x : float(x + cube(x) / 3);
  return float(signed_as(0.5 * (log2_of_positive((1 + a) / (1 - a)) * kLn2), x));
}

}  // namespace trueshade::oracle::glsl
