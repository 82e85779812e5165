#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// Colour and planes as an OpenEXR file of one part: scan lines, ZIP. The file comes in pieces that follow each other.
/// Blocks of 16 rows are packed and compressed on all threads at once. Error(usage) naming `where`: planes of several
/// sizes, names longer than 255 bytes.
std::vector<std::vector<uint8_t>> exr_file(const std::string& where, const Image& color,
                                           std::span<const NamedImage> aovs, const Metadata& metadata,
                                           const ImageFileOptions& options);

}  // namespace trueshade
