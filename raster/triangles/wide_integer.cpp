#include "raster/triangles/wide_integer.h"

#include <bit>
#include <cmath>

namespace trueshade {

WideInteger WideInteger::from_double(double value, int unit) {
  WideInteger out;
  if (value == 0.0) return out;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);  // exact, in [1/2, 1)
  out.limb_[0] = 0;
  uint64_t mantissa = uint64_t(std::ldexp(fraction, 53));
  int shift = exponent - 53 - unit;
  if (shift < 0) {  // the last bits are zero, as the caller promises
    assert(-shift < 64 && (mantissa & ((uint64_t(1) << -shift) - 1)) == 0);
    mantissa >>= -shift;
    shift = 0;
  }
  out.limb_[0] = uint32_t(mantissa);
  out.limb_[1] = uint32_t(mantissa >> 32);
  out = out.shifted_left(shift);
  out.negative_ = value < 0.0;
  return out;
}

WideInteger WideInteger::operator-() const {
  WideInteger out = *this;
  out.negative_ = !negative_;
  return out;
}

WideInteger WideInteger::operator+(const WideInteger& other) const {
  if (negative_ != other.negative_) {
    const bool larger = compare_magnitude(other) >= 0;
    WideInteger out = larger ? *this : other;
    out.subtract_magnitude(larger ? other : *this);
    return out;
  }
  WideInteger out = *this;
  uint64_t carry = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    carry += uint64_t(limb_[i]) + other.limb_[i];
    out.limb_[i] = uint32_t(carry);
    carry >>= 32;
  }
  assert(carry == 0);
  return out;
}

WideInteger WideInteger::operator*(const WideInteger& other) const {
  WideInteger out;
  const int used = (other.top() + 32) / 32;
  for (int i = 0; i <= top() / 32 && !is_zero(); ++i) {
    uint64_t carry = 0;
    for (int k = 0; k < used || carry != 0; ++k) {
      assert(i + k < kLimbs);
      carry += uint64_t(limb_[std::size_t(i)]) * (k < used ? other.limb_[std::size_t(k)] : 0) +
               out.limb_[std::size_t(i + k)];
      out.limb_[std::size_t(i + k)] = uint32_t(carry);
      carry >>= 32;
    }
  }
  out.negative_ = negative_ != other.negative_;
  return out;
}

int WideInteger::top() const {
  for (int i = kLimbs - 1; i >= 0; --i)
    if (limb_[std::size_t(i)] != 0) return 32 * i + 31 - std::countl_zero(limb_[std::size_t(i)]);
  return -1;
}

int WideInteger::compare_magnitude(const WideInteger& other) const {
  for (std::size_t i = kLimbs; i-- > 0;)
    if (limb_[i] != other.limb_[i]) return limb_[i] < other.limb_[i] ? -1 : 1;
  return 0;
}

void WideInteger::subtract_magnitude(const WideInteger& other) {
  int64_t borrow = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    borrow += int64_t(limb_[i]) - int64_t(other.limb_[i]);
    limb_[i] = uint32_t(borrow);
    borrow >>= 32;
  }
  assert(borrow == 0);
}

WideInteger WideInteger::shifted_left(int bits) const {
  assert(bits >= 0 && top() + bits < 32 * kLimbs);
  WideInteger out;
  out.negative_ = negative_;
  const int limbs = bits / 32, rest = bits % 32;
  for (int i = kLimbs - 1; i >= limbs; --i) {
    uint64_t pair = uint64_t(limb_[std::size_t(i - limbs)]) << 32;
    if (i > limbs) pair |= limb_[std::size_t(i - limbs - 1)];
    out.limb_[std::size_t(i)] = uint32_t(pair >> (32 - rest));
  }
  return out;
}

double WideInteger::rounded_quotient(const WideInteger& numerator, const WideInteger& denominator, int unit) {
  if (numerator.is_zero()) return 0.0;
  // A quotient of 54 or 55 bits and the knowledge whether anything is left decide the rounding to 53.
  const int shift = 54 - (numerator.top() - denominator.top());
  WideInteger rest = shift > 0 ? numerator.shifted_left(shift) : numerator;
  const WideInteger divisor = shift < 0 ? denominator.shifted_left(-shift) : denominator;
  rest.negative_ = false;
  uint64_t quotient = 0;
  for (int i = 55; i >= 0; --i) {
    WideInteger step = divisor.shifted_left(i);
    if (rest.compare_magnitude(step) < 0) continue;
    rest.subtract_magnitude(step);
    quotient |= uint64_t(1) << i;
  }
  const int extra = 64 - std::countl_zero(quotient) - 53;
  const uint64_t tail = quotient & ((uint64_t(1) << extra) - 1), half = uint64_t(1) << (extra - 1);
  uint64_t mantissa = quotient >> extra;
  const bool sticky = !rest.is_zero();
  if (tail > half || (tail == half && (sticky || (mantissa & 1)))) ++mantissa;
  const double magnitude = std::ldexp(double(mantissa), extra - shift + unit);
  return numerator.negative_ != denominator.negative_ ? -magnitude : magnitude;
}

}  // namespace trueshade
