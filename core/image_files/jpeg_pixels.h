#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"

namespace trueshade {

/// Size of a JPEG, from its frame header. Walks the whole stream and so refuses one that is cut off, which libjpeg
/// would fill with grey. Error(bad_input) naming `where`: not a JPEG, truncated, or of a kind other than 8 bits grey or
/// YCbCr.
struct JpegSize {
  int width, height;
};
JpegSize jpeg_size(const std::string& where, std::span<const uint8_t> bytes);

/// Its texels as rgba8, grey spread over R, G and B, alpha 255. `bytes` has passed jpeg_size() and its size is one the
/// caller accepts. Which codes a JPEG decodes to depends on the library: one build has one answer.
Image jpeg_pixels(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
