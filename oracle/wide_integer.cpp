#include "oracle/wide_integer.h"

#include <bit>
#include <cassert>
#include <cmath>

namespace trueshade::oracle {

namespace {
using Uint128 = unsigned __int128;
}  // namespace

WideInteger::WideInteger(int64_t value) : negative_(value < 0) {
  limb_[0] = value < 0 ? ~uint64_t(value) + 1 : uint64_t(value);
}

WideInteger WideInteger::from_float(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const int exponent = int((bits >> 23) & 0xff);
  assert(exponent != 255);
  const uint32_t fraction = bits & 0x7fffff;
  WideInteger result;
  result.negative_ = (bits >> 31) != 0;
  result.limb_[0] = exponent == 0 ? fraction : (fraction | 0x800000u);
  if (exponent > 1) result.shift_left(exponent - 1);
  return result;
}

int WideInteger::sign() const {
  for (const uint64_t limb : limb_)
    if (limb != 0) return negative_ ? -1 : 1;
  return 0;
}

int WideInteger::bit_length() const {
  for (int i = kLimbs - 1; i >= 0; --i)
    if (limb_[size_t(i)] != 0) return 64 * i + int(std::bit_width(limb_[size_t(i)]));
  return 0;
}

WideInteger WideInteger::operator-() const {
  WideInteger result = *this;
  result.negative_ = !negative_;
  return result;
}

WideInteger operator+(const WideInteger& a, const WideInteger& b) {
  WideInteger result = a;
  if (a.negative_ == b.negative_) {
    result.add_magnitude(b);
  } else if (a.compare_magnitude(b) >= 0) {
    result.subtract_magnitude(b);
  } else {
    result = b;
    result.subtract_magnitude(a);
  }
  return result;
}

WideInteger operator*(const WideInteger& a, const WideInteger& b) {
  assert(a.bit_length() <= 320 && b.bit_length() <= 320);
  WideInteger result;
  result.negative_ = a.negative_ != b.negative_;
  for (size_t i = 0; i < WideInteger::kLimbs / 2; ++i) {
    uint64_t carry = 0;
    for (size_t j = 0; j < WideInteger::kLimbs / 2; ++j) {
      const Uint128 sum = Uint128(a.limb_[i]) * b.limb_[j] + result.limb_[i + j] + carry;
      result.limb_[i + j] = uint64_t(sum);
      carry = uint64_t(sum >> 64);
    }
    result.limb_[i + WideInteger::kLimbs / 2] = carry;
  }
  return result;
}

int WideInteger::compare_magnitude(const WideInteger& other) const {
  for (size_t i = kLimbs; i-- > 0;)
    if (limb_[i] != other.limb_[i]) return limb_[i] < other.limb_[i] ? -1 : 1;
  return 0;
}

void WideInteger::add_magnitude(const WideInteger& other) {
  uint64_t carry = 0;
  for (size_t i = 0; i < kLimbs; ++i) {
    const Uint128 sum = Uint128(limb_[i]) + other.limb_[i] + carry;
    limb_[i] = uint64_t(sum);
    carry = uint64_t(sum >> 64);
  }
  assert(carry == 0);
}

void WideInteger::subtract_magnitude(const WideInteger& other) {
  uint64_t borrow = 0;
  for (size_t i = 0; i < kLimbs; ++i) {
    const Uint128 difference = Uint128(limb_[i]) - other.limb_[i] - borrow;
    limb_[i] = uint64_t(difference);
    borrow = uint64_t(difference >> 64) != 0 ? 1 : 0;
  }
  assert(borrow == 0);
}

void WideInteger::shift_left(int bits) {
  assert(bits >= 0 && bit_length() + bits <= 64 * kLimbs);
  const int limbs = bits / 64, rest = bits % 64;
  for (int i = kLimbs - 1; i >= 0; --i) {
    const uint64_t high = i >= limbs ? limb_[size_t(i - limbs)] : 0;
    const uint64_t low = i >= limbs + 1 ? limb_[size_t(i - limbs - 1)] : 0;
    limb_[size_t(i)] = rest == 0 ? high : (high << rest) | (low >> (64 - rest));
  }
}

void WideInteger::halve() {
  for (size_t i = 0; i < kLimbs; ++i) limb_[i] = (limb_[i] >> 1) | (i + 1 < kLimbs ? limb_[i + 1] << 63 : 0);
}

double nearest_quotient(const WideInteger& numerator, const WideInteger& denominator, int exponent) {
  assert(denominator.sign() != 0);
  if (numerator.sign() == 0) return 0.0;
  constexpr int kQuotientBits = 56;  // 53 to keep, one to round by, and some to spare
  WideInteger rest = numerator, divisor = denominator;
  const int shift = kQuotientBits - (numerator.bit_length() - denominator.bit_length());
  if (shift > 0) rest.shift_left(shift);
  if (shift < 0) divisor.shift_left(-shift);
  // Now 2^55 < rest / divisor < 2^57.
  divisor.shift_left(kQuotientBits);
  uint64_t quotient = 0;
  for (int i = 0; i <= kQuotientBits; ++i) {
    quotient <<= 1;
    if (rest.compare_magnitude(divisor) >= 0) {
      rest.subtract_magnitude(divisor);
      quotient |= 1;
    }
    divisor.halve();
  }
  // A last bit that says whether anything is left makes the conversion below the only rounding.
  quotient = (quotient << 1) | uint64_t(rest.sign() != 0);
  const double magnitude = std::ldexp(double(quotient), exponent - shift - 1);
  return numerator.negative_ != denominator.negative_ ? -magnitude : magnitude;
}

}  // namespace trueshade::oracle
