#pragma once
#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

/// A fault of the picture, with its parameter.
struct NamedFault {
  const PictureFault* fault = nullptr;
  FaultParameter parameter;
};

/// How many pixels of the image differ from what a right renderer makes, estimated from the sample, whose pixels it
/// predicts.
double changed_pixels(const PictureCase& picture);

/// Explains the wrong pixels of a picture: the likeliest findings first, as from diagnose(). None where fewer than
/// kLeastChanged pixels are wrong. Calls picture.make_tiles().
///   only: faults that are supposed, all together; empty: look for the likeliest
std::vector<Finding> picture_findings(PictureCase& picture, std::span<const NamedFault> only);

/// The fault's name with its parameter: `light-range=1.01`, `light-moved=3:0.5,0,0`; the name alone where it has none.
std::string name_of(const PictureFault& fault, const FaultParameter& parameter);
/// The fault's sentence with its parameter, without its full stop.
std::string text_of(const PictureFault& fault, const FaultParameter& parameter);

}  // namespace trueshade::oracle
