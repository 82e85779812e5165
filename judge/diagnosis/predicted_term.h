#pragma once
// What one light adds to a surface, by the light model and the fault of a pass.
#include "judge/diagnosis/light_pass.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// What lights add to one surface under a light pass. Borrows the pass.
class PredictedTerms {
 public:
  /// Computes what depends on the surface alone.
  PredictedTerms(const LightPass& pass, const PlainSurface& surface);

  /// What the sum of the lights starts from, R, G, B, by the pass's light program, which must be there.
  Triple3 start() const;
  /// What finish() of the light program returns for a sum; the sum and `alpha` unchanged where there is no finish().
  std::array<double, 4> finished(const Triple3& sum, double alpha) const;

  /// What one fragment of a light adds to the sum, R, G, B. `surface` must be the constructor's.
  Triple3 term(const PlainSurface& surface, const Light& light) const;
  /// Whether the surface is within the light's range, which the fault may have changed; true for a light without a
  /// place.
  bool in_range(const PlainSurface& surface, const Light& light) const;
  /// How many fragments of the light are drawn at the surface's pixel.
  int fragments(const PlainSurface& surface, const Light& light) const;

 private:
  Triple3 term_of_program(const Light& light) const;
  Triple3 unit_of(const Triple3& v) const;
  Triple3 place_of(const Light& light) const;
  double falloff(const Light& light, double d) const;
  double cone(const Light& light, double c) const;
  double cosine_to_half(const Triple3& l, double n_l) const;

  const LightPass& pass_;
  const LightModel& model_;
  Triple3 normal_{}, viewer_{};
  mutable std::vector<double> values_;  ///< of the light program at the surface
};

}  // namespace trueshade::oracle
