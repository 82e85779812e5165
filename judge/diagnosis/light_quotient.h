#pragma once
// Measures how much more or less light a picture shows than it should, as a function of a quantity that light models
// depend on: for pictures that no known fault explains.
#include <optional>
#include <string>
#include <vector>

#include "judge/diagnosis/finding.h"

namespace trueshade::oracle {

/// The factor that each light's term seems to have been multiplied by, as a function of one quantity. Fitted by least
/// squares to all lights of the sampled pixels at once.
struct LightQuotient {
  std::string against;  ///< "d / range", "N.L", "N.H", "light"
  struct Step {
    double from = 0, to = 0;  ///< of the quantity; of lights both are the index
    double factor = 1;
  };
  std::vector<Step> curve;  ///< only where light falls in the picture; ascending
  double left = 1;          ///< root mean square of the difference that these factors leave, as a share of that without
                            ///< them
  std::string text;         ///< the plainest description of the curve, a sentence without its full stop
};

/// Finds what explains best how a picture whose lights are summed differs: missing lights, or a factor that depends on
/// one quantity. Nothing where no such thing explains half of it, where no pixel is a violation, where lights are
/// blended, and where a light program's finish() stands between the sum and the picture.
///   lighting: the stage of the lights, by the same pipeline and profile
std::optional<LightQuotient> light_quotient(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                            const Capture& capture, const StageVerdict& lighting);

/// A number with three significant digits.
std::string digits(double x);

/// A quotient as JSON: {against, curve [{from, to, factor}], left, text}.
std::string quotient_json(const LightQuotient& quotient);

}  // namespace trueshade::oracle
