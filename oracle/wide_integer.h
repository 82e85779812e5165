#pragma once
#include <array>
#include <cstdint>

namespace trueshade::oracle {

/// A signed integer of 640 bits, held as sign and magnitude. Wide enough for a product of two sums of two floats, each
/// float counted in units of 2^-149: 2 * 278 bits, and 57 more for the long division.
class WideInteger {
 public:
  static constexpr int kLimbs = 10;

  WideInteger() = default;
  explicit WideInteger(int64_t value);
  /// value * 2^149, which is an integer for every finite float.
  static WideInteger from_float(float value);

  int sign() const;        ///< -1, 0 or 1
  int bit_length() const;  ///< of the magnitude; 0 for 0
  WideInteger operator-() const;
  friend WideInteger operator+(const WideInteger& a, const WideInteger& b);
  friend WideInteger operator-(const WideInteger& a, const WideInteger& b) { return a + (-b); }
  /// Both magnitudes below 2^320.
  friend WideInteger operator*(const WideInteger& a, const WideInteger& b);
  friend bool operator==(const WideInteger& a, const WideInteger& b) { return (a - b).sign() == 0; }

 private:
  friend double nearest_quotient(const WideInteger& numerator, const WideInteger& denominator, int exponent);
  int compare_magnitude(const WideInteger& other) const;
  void add_magnitude(const WideInteger& other);
  void subtract_magnitude(const WideInteger& other);  ///< |this| >= |other|
  void shift_left(int bits);
  void halve();

  bool negative_ = false;
  std::array<uint64_t, kLimbs> limb_{};  ///< least significant first
};

/// numerator / denominator * 2^exponent, rounded once to the nearest double, ties to even. The result must be normal or
/// 0. By the long division of school, a bit at a time; denominator not 0, both magnitudes below 2^580.
double nearest_quotient(const WideInteger& numerator, const WideInteger& denominator, int exponent);

}  // namespace trueshade::oracle
