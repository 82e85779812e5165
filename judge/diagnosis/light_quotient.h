#pragma once
// How much more or less light a picture shows than it should, against what a light model could depend on: for pictures
// that no known fault explains.
#include <optional>
#include <string>
#include <vector>

#include "judge/diagnosis/finding.h"

namespace trueshade::oracle {

/// The factor that each light's term seems to have had, as a function of one quantity, by least squares over sampled
/// pixels of all their lights at once.
struct LightQuotient {
  std::string against;  ///< "d / range", "N.L", "N.H", "light"
  struct Step {
    double from = 0, to = 0;  ///< of the quantity; of lights both are the index
    double factor = 1;
  };
  std::vector<Step> curve;  ///< where light falls in the picture; ascending
  double left = 1;          ///< root mean square of the difference under these factors, a share of that without
  std::string text;         ///< the plainest description of the curve, a sentence without its full stop
};

/// What explains best the difference of a picture whose lights are summed: missing lights, or a factor against one
/// quantity. Nothing where none explains half of it, where no pixel is a violation, where lights are blended, and where
/// a light program's finish() stands between the sum and the picture.
///   lighting: the stage of the lights, by the same pipeline and profile
std::optional<LightQuotient> light_quotient(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                            const Capture& capture, const StageVerdict& lighting);

/// A number with three digits that count.
std::string digits(double x);

/// A quotient as JSON: {against, curve [{from, to, factor}], left, text}.
std::string quotient_json(const LightQuotient& quotient);

}  // namespace trueshade::oracle
