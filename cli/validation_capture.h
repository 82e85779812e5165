#pragma once
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Planes as files hold them, before they are known to be those of a pipeline.
/// `image_file` may be empty: then the picture is the R G B A of `gbuffer_file`, if it has them.
oracle::Capture capture_from_files(const std::string& gbuffer_file, const std::string& image_file);

/// Puts each plane into the format the pipeline stores it in, which decides what is legal: codes of rgba8 from their
/// floats, halves from floats that are halves, identifiers from whole numbers. Error(bad_input) naming `where`, plane
/// and the pixel (from the top left) of a value that the format cannot hold, for sizes other than the pipeline's, for
/// depths and texture coordinates in halves that the pipeline stores in floats. A picture of R, G and B alone gets an
/// alpha of 1, which is not judged.
void store_as(const Pipeline& pipeline, const std::string& where, oracle::Capture& capture);

}  // namespace trueshade
