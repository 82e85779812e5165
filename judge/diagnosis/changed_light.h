#pragma once
// Finds which one light of a picture is wrong, and by which numbers it is changed.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// likely_parameters() for a fault of Search::one_light: tries to change each of the scene's first 1024 lights, such as
/// by an offset of its position, with the fault's numbers fitted by least squares. Returns the two lights at most whose
/// change explains most. A light does not fit where its numbers are not finite, where it is dark then, and where the
/// picture rather shows that it is missing or drawn twice. Empty where none fits, and where tiles are supposed.
std::vector<FaultParameter> changed_lights(const PictureCase& picture, const PictureSupposition& supposed,
                                           const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                           const std::vector<double>& off_if_right);

}  // namespace trueshade::oracle
