#pragma once
#include <cstdint>

namespace trueshade {

/// PCG-XSH-RR 64/32 (Melissa O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
/// Random Number Generation", 2014). Our own, since the standard's distributions differ between libraries.
/// Draw twice in one expression only within braces: C++ leaves the order of arguments and operands to the compiler, and
/// g++ and clang do differ.
class Pcg32 {
 public:
  explicit Pcg32(uint64_t seed, uint64_t stream = 0) : increment_((stream << 1) | 1) {
    next();
    state_ += seed;
    next();
  }

  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005u + increment_;
    const uint32_t shifted = uint32_t(((old >> 18) ^ old) >> 27);
    const uint32_t turn = uint32_t(old >> 59);
    return (shifted >> turn) | (shifted << ((32 - turn) & 31));
  }

  /// In [0, count), by the high half of a product: the bias is below 2^-32 * count. count >= 1.
  uint32_t below(uint32_t count) { return uint32_t((uint64_t(next()) * count) >> 32); }

  /// In [0, 1), a multiple of 2^-32; exact.
  double real() { return double(next()) * (1.0 / 4294967296.0); }

  double between(double low, double high) { return low + (high - low) * real(); }

 private:
  uint64_t state_ = 0, increment_;
};

}  // namespace trueshade
