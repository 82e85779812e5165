#pragma once
// What one light adds to a surface, by the light model and the fault of a pass.
#include "judge/diagnosis/light_pass.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// The terms of a light pass at one surface. Borrows the pass.
class PredictedTerms {
 public:
  PredictedTerms(const LightPass& pass, const PlainSurface& surface);

  /// What the sum of a light program starts from, and what becomes of it; of a light model it is as it stands.
  Triple3 start() const;
  std::array<double, 4> finished(const Triple3& sum, double alpha) const;

  /// What a light adds to the sum.
  Triple3 term(const PlainSurface& surface, const Light& light) const;
  bool in_range(const PlainSurface& surface, const Light& light) const;
  /// How often the light is drawn at the surface's pixel.
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
