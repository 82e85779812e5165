#pragma once
// Finds which one light of a picture is wrong, and by which numbers it is changed.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// likely_parameters() of a fault of Search::one_light: the two lights at most whose change explains most, each with
/// the fault's numbers, such as an offset of the light's position, by least squares. Empty where tiles are supposed,
/// and where no light fits: its numbers are not finite, it is dark then, or it is a light that is missing or drawn
/// twice. Tries the scene's first 1024 lights.
std::vector<FaultParameter> changed_lights(const PictureCase& picture, const PictureSupposition& supposed,
                                           const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                           const std::vector<double>& off_if_right);

}  // namespace trueshade::oracle
