#pragma once

namespace trueshade {

/// A shininess as docs/arithmetic.md section 8 splits it: an even integer s is (t^2 / h^2)^(s/2), any other (t /
/// |h|)^s.
struct Exponent {
  bool squared;  ///< the base is a square already
  int integer;   ///< 0..8192, or -1: not an integer
  int top_bit;   ///< of `integer`
  double value;
};

Exponent exponent_of_shininess(float shininess);

/// x^p for x >= 0: exp2(p log2 x) in double (docs/arithmetic.md section 9). Relative error below 2^-40 while the result
/// is a normal float. power(0, p) = 0 for p > 0.
double power(double x, double p);

}  // namespace trueshade
