#pragma once
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Puts each plane into the format the pipeline stores it in, which decides what is legal: codes of rgba8 from their
/// floats, halves from floats that are halves, identifiers from whole numbers. A picture and an albedo of R, G and B
/// alone get an alpha of 1, which is not judged; Capture::has_alpha becomes false where the target's alpha is that of
/// such an albedo. Unpacked planes, and those that light programs alone read, stay as they are. Error(bad_input) for a
/// value that the format cannot hold, naming the plane's file, the plane and the pixel (from the top left); also for
/// another number of channels, for halves where the pipeline stores floats, and for sizes other than the pipeline's.
void store_as(const Pipeline& pipeline, oracle::Capture& capture);

}  // namespace trueshade
