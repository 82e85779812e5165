#pragma once
// What a target's texels hold after stores and blends, by a rounding rule that a fault may have changed.
#include "judge/diagnosis/light_pass.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// A number rounded to `bits` bits of fraction, as a float whose exponent is at least `least`: to nearest, unless the
/// rule truncates or rounds away from 0 (`upward`). 0, NaN and infinity stay as they are.
double rounded_to(double x, int bits, int least, LightFault::Store rule);

/// Stores and blends into texels of the pipeline's target, which hold codes or floats. Borrows the pipeline.
class PredictedStore {
 public:
  /// Takes the rule to round by; `right` is the pipeline's own.
  PredictedStore(const Pipeline& pipeline, LightFault::Store rule);
  /// What a channel holds once x is stored: a code or a float. For codes x is clamped to [0, 1], and NaN is 0.
  double stored(double x, int channel) const;
  /// Blends a fragment over a texel, in place; the texel holds codes or floats.
  void blend(const Triple3& source, double alpha, const BlendState& state, std::array<double, 4>& texel) const;

 private:
  double code_of(double x, int channel) const;
  double half_of(double x) const;
  HalfRound half_round() const {
    return rule_ == LightFault::Store::truncated ? HalfRound::toward_zero : HalfRound::nearest;
  }

  const Pipeline& pipeline_;
  const FormatInfo layout_;
  LightFault::Store rule_;
  bool codes_ = false, halves_ = false;
};

}  // namespace trueshade::oracle
