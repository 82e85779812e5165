#pragma once
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// A fault with its parameter.
struct NamedFault {
  const PictureFault* fault = nullptr;
  FaultParameter parameter;
};

/// How many pixels of the image are not as a right renderer makes them, estimated by the sample. Predicts each of its
/// pixels.
double changed_pixels(const PictureCase& picture);

/// Findings about the picture, the likeliest first, as diagnose() has them; none where fewer than kLeastChanged pixels
/// are wrong. Makes the picture's tiles.
///   only: faults that are supposed, all together; empty: look for the likeliest
std::vector<Finding> picture_findings(PictureCase& picture, std::span<const NamedFault> only);

/// `light-range=1.01`, `light-moved=3:0.5,0,0`; a fault without a parameter by its name alone.
std::string name_of(const PictureFault& fault, const FaultParameter& parameter);
/// The fault's sentence with its parameter.
std::string text_of(const PictureFault& fault, const FaultParameter& parameter);

}  // namespace trueshade::oracle
