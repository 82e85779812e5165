#pragma once
// Estimates the parameter of a fault of the picture from sampled pixels.
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// The parameters with which a fault, supposed beside other faults, explains most of `pixels`; the best first. A fault
/// without a parameter gives one that means nothing. Empty where nothing points at a parameter. Where the parameter
/// is searched for, predicts the pixels some dozens of times or more.
///   off_if_right: how many steps each of `pixels` is off without any fault
std::vector<FaultParameter> likely_parameters(const PictureCase& picture, const PictureSupposition& supposed,
                                              const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                              const std::vector<double>& off_if_right);

}  // namespace trueshade::oracle
