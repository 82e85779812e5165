#include <algorithm>
#include <stdexcept>

#include "oracle/light_functions.h"
#include "oracle/spirv_opcodes.h"
#include "oracle/spirv_operations.h"
#include "oracle/spirv_scalars.h"

namespace trueshade::oracle {

namespace {

using namespace spirv;

float lesser(float a, float b) { return a < b ? a : b; }
float greater(float a, float b) { return a > b ? a : b; }
float clamped(float x, float low, float high) { return lesser(greater(x, low), high); }

float smooth_step(float e0, float e1, float x) {
  const float t = clamped((x - e0) / (e1 - e0), 0, 1);
  return (t * t) * (3 - 2 * t);
}

float scaled_by_power_of_two(float x, uint32_t exponent) {
  const int n = std::clamp(int32_t(exponent), -300, 300);
  return float(double(x) * std::ldexp(1.0, n));
}

float of_one(uint32_t function, float x) {
  switch (function) {
    case Round:
    case RoundEven:
      return std::rint(x);
    case Trunc:
      return std::trunc(x);
    case FAbs:
      return real_of(bits_of(x) & 0x7FFFFFFFu);
    case FSign:
      return x > 0 ? 1.0f : x < 0 ? -1.0f : 0.0f;
    case Floor:
      return std::floor(x);
    case Ceil:
      return std::ceil(x);
    case Fract:
      return x - std::floor(x);
    case Radians:
      return x * 0x1.1df46ap-6f;  // pi/180
    case Degrees:
      return x * 0x1.ca5dc2p+5f;  // 180/pi
    case Sin:
      return glsl::sin(x);
    case Cos:
      return glsl::cos(x);
    case Tan:
      return glsl::tan(x);
    case Asin:
      return glsl::asin(x);
    case Acos:
      return glsl::acos(x);
    case Atan:
      return glsl::atan(x);
    case Sinh:
      return glsl::sinh(x);
    case Cosh:
      return glsl::cosh(x);
    case Tanh:
      return glsl::tanh(x);
    case Asinh:
      return glsl::asinh(x);
    case Acosh:
      return glsl::acosh(x);
    case Atanh:
      return glsl::atanh(x);
    case Exp:
      return glsl::exp(x);
    case Log:
      return glsl::log(x);
    case Exp2:
      return glsl::exp2(x);
    case Log2:
      return glsl::log2(x);
    case Sqrt:
      return std::sqrt(x);
    case InverseSqrt:
      return 1 / std::sqrt(x);
    default:
      throw std::runtime_error("GLSL.std.450: function " + std::to_string(function) + " is none of a light program's");
  }
}

uint32_t of_reals(uint32_t function, uint32_t x, uint32_t y, uint32_t z) {
  const float a = real_of(x), b = real_of(y), c = real_of(z);
  switch (function) {
    case Atan2:
      return bits_of(glsl::atan2(a, b));
    case Pow:
      return bits_of(glsl::pow(a, b));
    case FMin:
      return bits_of(lesser(a, b));
    case FMax:
      return bits_of(greater(a, b));
    case FClamp:
      return bits_of(clamped(a, b, c));
    case FMix:
      return bits_of(a * (1 - c) + b * c);
    case Step:
      return bits_of(b < a ? 0.0f : 1.0f);
    case SmoothStep:
      return bits_of(smooth_step(a, b, c));
    case Fma:
      return bits_of(std::fma(a, b, c));
    case Ldexp:
      return bits_of(scaled_by_power_of_two(a, y));
    default:
      return bits_of(of_one(function, a));
  }
}

uint32_t highest_bit(uint32_t x) { return x == 0 ? 0xFFFFFFFFu : uint32_t(31 - std::countl_zero(x)); }

/// Of one component of each operand; those that are absent are 0.
uint32_t component_of(uint32_t function, uint32_t a, uint32_t b, uint32_t c) {
  const auto i = int32_t(a), j = int32_t(b), k = int32_t(c);
  switch (function) {
    case SAbs:
      return i < 0 ? 0 - a : a;
    case SSign:
      return uint32_t(i > 0 ? 1 : i < 0 ? -1 : 0);
    case UMin:
      return std::min(a, b);
    case SMin:
      return uint32_t(std::min(i, j));
    case UMax:
      return std::max(a, b);
    case SMax:
      return uint32_t(std::max(i, j));
    case UClamp:
      return std::min(std::max(a, b), c);
    case SClamp:
      return uint32_t(std::min(std::max(i, j), k));
    case FindILsb:
      return a == 0 ? 0xFFFFFFFFu : uint32_t(std::countr_zero(a));
    case FindUMsb:
      return highest_bit(a);
    case FindSMsb:
      return highest_bit(i < 0 ? ~a : a);
    default:
      return of_reals(function, a, b, c);
  }
}

Scalars by_components(uint32_t function, const std::vector<SpirvValue>& operands) {
  Scalars result;
  for (size_t i = 0; i < operands[0].scalars.size(); ++i) {
    uint32_t x[3] = {0, 0, 0};
    for (size_t k = 0; k < operands.size(); ++k) x[k] = operands[k].scalars[i];
    result.push_back(component_of(function, x[0], x[1], x[2]));
  }
  return result;
}

/// 16 bits of a half, to nearest even; one NaN of all.
uint32_t half_bits(float x) {
  if (std::isnan(x)) return 0x7E00;
  const uint32_t sign = std::signbit(x) ? 0x8000 : 0;
  const double a = std::fabs(double(x));
  if (a == 0) return sign;
  if (a >= 65520) return sign | 0x7C00;
  // Below 2^-14 a half counts steps of 2^-24; from there on its bits grow by one a step, whatever the exponent.
  int e = 0;
  std::frexp(a, &e);
  const int exponent = std::max(e - 1, -14);
  const double steps = std::rint(std::ldexp(a, 10 - exponent));
  return sign | uint32_t((exponent + 14) * 1024 + int(steps));
}

float real_of_half(uint32_t bits) {
  const uint32_t exponent = bits >> 10 & 31, fraction = bits & 1023;
  float magnitude = std::ldexp(float(fraction), -24);
  if (exponent == 31) magnitude = real_of(0x7F800000u | fraction << 13);
  if (exponent != 31 && exponent != 0) magnitude = std::ldexp(float(1024 + fraction), int(exponent) - 25);
  return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

/// How a packed number is divided: parts of some bits, each -M .. M or 0 .. M.
struct Packing {
  int bits;
  bool is_signed;
  float most;  ///< M
};

Packing packing_of(uint32_t function) {
  switch (function) {
    case PackSnorm4x8:
    case UnpackSnorm4x8:
      return {8, true, 127};
    case PackUnorm4x8:
    case UnpackUnorm4x8:
      return {8, false, 255};
    case PackSnorm2x16:
    case UnpackSnorm2x16:
      return {16, true, 32767};
    default:
      return {16, false, 65535};
  }
}

Scalars packed(uint32_t function, const Reals& x) {
  const Packing packing = packing_of(function);
  uint32_t result = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const float code = std::rint(clamped(x[i], packing.is_signed ? -1 : 0, 1) * packing.most);
    const uint32_t bits =
        function == PackHalf2x16 ? half_bits(x[i]) : uint32_t(int32_t(code)) & ((1u << packing.bits) - 1);
    result |= bits << (int(i) * packing.bits);
  }
  return {result};
}

Scalars unpacked(uint32_t function, uint32_t x) {
  const Packing packing = packing_of(function);
  Reals result;
  for (int shift = 0; shift < 32; shift += packing.bits) {
    const uint32_t code = x >> shift & ((1u << packing.bits) - 1);
    float value = 0;
    if (function == UnpackHalf2x16)
      value = real_of_half(code);
    else if (packing.is_signed)
      value = clamped(float(packing.bits == 8 ? int32_t(int8_t(code)) : int32_t(int16_t(code))) / packing.most, -1, 1);
    else
      value = float(code) / packing.most;
    result.push_back(value);
  }
  return scalars_of(result);
}

/// Significands, then exponents.
Scalars fraction_and_exponent(const Reals& x) {
  Scalars fractions, exponents;
  for (const float value : x) {
    int exponent = 0;
    const bool usual = value != 0 && std::isfinite(value);
    fractions.push_back(bits_of(usual ? std::frexp(value, &exponent) : value));
    exponents.push_back(uint32_t(exponent));
  }
  fractions.insert(fractions.end(), exponents.begin(), exponents.end());
  return fractions;
}

/// Fractional parts, then whole ones.
Scalars part_and_whole(const Reals& x) {
  Reals parts, wholes;
  for (const float value : x) wholes.push_back(std::trunc(value)), parts.push_back(value - wholes.back());
  parts.insert(parts.end(), wholes.begin(), wholes.end());
  return scalars_of(parts);
}

Reals cross_of(const Reals& a, const Reals& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A square matrix: columns of rows.
using Square = std::vector<Reals>;

Square square_of(const Scalars& scalars) {
  const size_t n = scalars.size() == 4 ? 2 : scalars.size() == 9 ? 3 : 4;
  Square columns;
  for (size_t c = 0; c < n; ++c) columns.push_back(reals_of(std::span(scalars).subspan(c * n, n)));
  return columns;
}

/// What is left of a matrix without one column and one row.
Square without(const Square& m, size_t column, size_t row) {
  Square left;
  for (size_t c = 0; c < m.size(); ++c) {
    if (c == column) continue;
    Reals rows = m[c];
    rows.erase(rows.begin() + std::ptrdiff_t(row));
    left.push_back(rows);
  }
  return left;
}

float determinant_of(const Square& m) {
  if (m.size() == 1) return m[0][0];
  if (m.size() == 2) return m[0][0] * m[1][1] - m[1][0] * m[0][1];
  if (m.size() == 3) return dot_of(m[0], cross_of(m[1], m[2]));
  float d[4];
  for (size_t r = 0; r < 4; ++r) d[r] = determinant_of(without(m, 0, r));
  return ((m[0][0] * d[0] - m[0][1] * d[1]) + m[0][2] * d[2]) - m[0][3] * d[3];
}

Scalars inverse_of(const Square& m) {
  const float r = 1 / determinant_of(m);
  Scalars inverse;
  for (size_t column = 0; column < m.size(); ++column)
    for (size_t row = 0; row < m.size(); ++row) {
      // The transpose: the cofactor of what stands in column `row` and row `column`.
      float cofactor = determinant_of(without(m, row, column));
      if ((row + column) % 2 != 0) cofactor = real_of(bits_of(cofactor) ^ 0x80000000u);
      inverse.push_back(bits_of(cofactor * r));
    }
  return inverse;
}

float length_of(const Reals& v) { return std::sqrt(dot_of(v, v)); }

Reals normalized(const Reals& v) {
  const float l2 = dot_of(v, v), r = l2 > 0 ? 1 / std::sqrt(l2) : 0;
  Reals result;
  for (const float x : v) result.push_back(x * r);
  return result;
}

Reals difference(const Reals& a, const Reals& b) {
  Reals result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(a[i] - b[i]);
  return result;
}

Reals reflected(const Reals& i, const Reals& n) {
  const float twice = 2 * dot_of(n, i);
  Reals result;
  for (size_t k = 0; k < i.size(); ++k) result.push_back(i[k] - twice * n[k]);
  return result;
}

Reals refracted(const Reals& i, const Reals& n, float eta) {
  const float d = dot_of(n, i), k = 1 - (eta * eta) * (1 - d * d);
  if (k < 0) return Reals(i.size(), 0);
  const float across = eta * d + std::sqrt(k);
  Reals result;
  for (size_t at = 0; at < i.size(); ++at) result.push_back(eta * i[at] - across * n[at]);
  return result;
}

Reals facing(const Scalars& n, const Reals& i, const Reals& reference) {
  const bool keep = dot_of(reference, i) < 0;
  Reals result;
  for (const uint32_t bits : n) result.push_back(real_of(keep ? bits : bits ^ 0x80000000u));
  return result;
}

}  // namespace

std::vector<uint32_t> glsl_function(uint32_t function, const std::vector<SpirvValue>& operands) {
  const auto reals = [&](size_t at) { return reals_of(operands[at].scalars); };
  switch (function) {
    case Determinant:
      return {bits_of(determinant_of(square_of(operands[0].scalars)))};
    case MatrixInverse:
      return inverse_of(square_of(operands[0].scalars));
    case Modf:
    case ModfStruct:
      return part_and_whole(reals(0));
    case Frexp:
    case FrexpStruct:
      return fraction_and_exponent(reals(0));
    case PackSnorm4x8:
    case PackUnorm4x8:
    case PackSnorm2x16:
    case PackUnorm2x16:
    case PackHalf2x16:
      return packed(function, reals(0));
    case UnpackSnorm2x16:
    case UnpackUnorm2x16:
    case UnpackHalf2x16:
    case UnpackSnorm4x8:
    case UnpackUnorm4x8:
      return unpacked(function, operands[0].scalars[0]);
    case Length:
      return {bits_of(length_of(reals(0)))};
    case Distance:
      return {bits_of(length_of(difference(reals(0), reals(1))))};
    case Cross:
      return scalars_of(cross_of(reals(0), reals(1)));
    case Normalize:
      return scalars_of(normalized(reals(0)));
    case FaceForward:
      return scalars_of(facing(operands[0].scalars, reals(1), reals(2)));
    case Reflect:
      return scalars_of(reflected(reals(0), reals(1)));
    case Refract:
      return scalars_of(refracted(reals(0), reals(1), real_of(operands[2].scalars[0])));
    default:
      return by_components(function, operands);
  }
}

}  // namespace trueshade::oracle
