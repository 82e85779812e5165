#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image_files/image_io.h"

namespace trueshade {

/// Size, channels and uncompressed text of a PNG, read from its chunks. Our own, because libpng reports a bad file on
/// standard error itself. Decodes no pixels and checks no CRC. Error(bad_input) naming `where` and the byte offset.
ImageFileInfo png_header(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
