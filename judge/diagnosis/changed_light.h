#pragma once
// One light that is not as it should be: which, and what is changed of it.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// Parameters of a fault of one light, as likely_parameters() has them: the lights that explain most by least squares
/// in three numbers, such as an offset of their position.
std::vector<FaultParameter> changed_lights(const PictureCase& picture, const PictureSupposition& supposed,
                                           const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                           const std::vector<double>& off_if_right);

}  // namespace trueshade::oracle
