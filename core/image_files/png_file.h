#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// The image as a PNG: IHDR, the tag of its codes, the metadata as text, IDAT, IEND. The file comes in pieces that follow
/// each other. Every row is filtered by Up, and all rows are one zlib stream, whose parts are made on all threads at once.
/// Error(usage) naming `where` for metadata that a PNG cannot name.
std::vector<std::vector<uint8_t>> png_file(const std::string& where, const Image& image, const Metadata& metadata,
                                           const ImageFileOptions& options);

}  // namespace trueshade
