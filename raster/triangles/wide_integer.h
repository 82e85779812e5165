#pragma once
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace trueshade {

/// Signed integer of up to 768 bits in sign and magnitude, for values that must be rounded once: a product of two
/// differences of floats needs 2 * (277 + 1) bits, and a quotient's dividend 64 more. Slow, and seldom needed.
class WideInteger {
 public:
  WideInteger() = default;

  /// value / 2^unit, which must be an integer: unit is at most the exponent of value's last bit.
  static WideInteger from_double(double value, int unit);

  WideInteger operator-() const;
  WideInteger operator+(const WideInteger& other) const;
  WideInteger operator-(const WideInteger& other) const { return *this + (-other); }
  WideInteger operator*(const WideInteger& other) const;

  bool is_zero() const { return top() < 0; }
  bool negative() const { return negative_ && !is_zero(); }

  /// RN64(numerator / denominator * 2^unit), ties to even. denominator != 0; no overflow, no subnormal result.
  static double rounded_quotient(const WideInteger& numerator, const WideInteger& denominator, int unit);

 private:
  static constexpr int kLimbs = 24;  // of 32 bits
  int top() const;                   // index of the highest set bit, -1 for zero
  int compare_magnitude(const WideInteger& other) const;
  void subtract_magnitude(const WideInteger& other);  // |this| >= |other|
  WideInteger shifted_left(int bits) const;

  std::array<uint32_t, kLimbs> limb_{};  // least significant first
  bool negative_ = false;
};

}  // namespace trueshade
