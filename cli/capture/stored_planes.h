#pragma once
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Puts each plane into the format the pipeline stores it in, which decides what is legal: codes of rgba8 from their
/// floats, halves from floats that are halves, identifiers from whole numbers. Error(bad_input) naming the plane's
/// file, the plane and the pixel (from the top left) of a value that the format cannot hold, for sizes other than the
/// pipeline's. A picture of R, G and B alone gets an alpha of 1, which is not judged. Unpacked planes stay as they are.
void store_as(const Pipeline& pipeline, oracle::Capture& capture);

}  // namespace trueshade
