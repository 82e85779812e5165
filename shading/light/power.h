#pragma once
#include "scenes/pipeline/light_model.h"

namespace trueshade {

/// An exponent as docs/arithmetic.md section 8 splits it: under Blinn-Phong an even integer s is (t^2 / h^2)^(s/2), any
/// other exponent (t / |h|)^s.
struct Exponent {
  bool squared;  ///< the base is a square already
  int integer;   ///< 0..8192, or -1: not an integer
  double value;
};

/// What an exponent is applied to: always to the cosine, or to its square where the exponent is an even integer.
enum class PowerBase : uint8_t { cosine, square_if_even };
Exponent exponent_of(float exponent, PowerBase base = PowerBase::cosine);
inline Exponent exponent_of(const LightModel& model) {
  return exponent_of(model.shininess,
                     model.specular == Specular::blinn_phong ? PowerBase::square_if_even : PowerBase::cosine);
}

/// Base 2, x > 0; and 2^t. In double, to the last bits (docs/arithmetic.md section 9).
double log2_of(double x);
double exp2_of(double t);

/// x^p for x >= 0: exp2(p log2 x) in double (docs/arithmetic.md section 9). Relative error below 2^-40 while the result
/// is a normal float. For p > 0, power(0, p) = 0 and that of infinity is infinity.
double power(double x, double p);

}  // namespace trueshade
