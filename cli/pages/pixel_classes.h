#pragma once
#include <string>

#include "cli/pages/layer.h"
#include "judge/stages/verdict.h"

namespace trueshade {

/// The classes of a stage as a page shows them, in the order of PixelClass: a colour, a sentence, how many pixels.
/// left_out is the last where there is one.
std::vector<LayerClass> classes_of(const oracle::StageVerdict& stage);

/// The square of a class's colour, and its name, as HTML.
std::string class_key(oracle::PixelClass c);

/// The classes of a stage as a picture of at most kLargestFigure pixels a side. Violations are drawn 3 x 3, over
/// whatever is beside them, so that one is seen.
Image class_picture(const oracle::StageVerdict& stage);

}  // namespace trueshade
