#pragma once
// Estimates the parameter of a fault of the picture from sampled pixels.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// Parameters with which the fault, beside those that are supposed already, explains most of `pixels`; the best first.
/// At least one, unless the fault has a parameter that nothing points at. Predicts the pixels some dozens of times or
/// more where the parameter is searched for.
///   off_if_right: steps that each of `pixels` is off without any fault
std::vector<FaultParameter> likely_parameters(const PictureCase& picture, const PictureSupposition& supposed,
                                              const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                              const std::vector<double>& off_if_right);

}  // namespace trueshade::oracle
