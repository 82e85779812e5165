#pragma once
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Converts each plane to the format that the pipeline stores it in, which decides what values are legal: codes of
/// rgba8 from their floats, halves from floats that are halves, identifiers from whole numbers. A picture and an albedo
/// of R, G and B alone get an alpha of 1, which is not judged; Capture::has_alpha becomes false where the target's
/// alpha would be that of such an albedo. Unpacked planes, and those that light programs alone read, are left alone.
/// Error(bad_input), naming the file, the plane and the pixel (from the top left), for a value that the format cannot
/// hold; also for another number of channels, for halves where the pipeline stores floats, and for sizes other than the
/// pipeline's.
void store_as(const Pipeline& pipeline, oracle::Capture& capture);

}  // namespace trueshade
