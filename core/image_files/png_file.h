#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// Encodes an image as a PNG. The result is the file in pieces, which follow each other. The chunks are IHDR, the tag
/// that says what the codes mean (png_codes.h), one text a metadata entry, IDAT and IEND. Every row is filtered by Up.
/// All rows form one zlib stream, whose parts are compressed on all threads at once. Error(usage) naming `where` for a
/// metadata key that a PNG cannot hold.
std::vector<std::vector<uint8_t>> png_file(const std::string& where, const Image& image, const Metadata& metadata,
                                           const ImageFileOptions& options);

}  // namespace trueshade
