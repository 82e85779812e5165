#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"

namespace trueshade {

/// Decodes a PNG of any colour type, depth and interlacing. The image is rgba16 if the channels of the file have 16
/// bits, else rgba8. Codes are taken as they are stored, and those of fewer than 8 bits are widened; no gamma and no
/// profile is applied. Grey becomes equal R, G and B. Alpha is taken from the file's alpha channel or from its palette;
/// a file that names one transparent colour has alpha 0 at that colour; elsewhere alpha is 1. This is no call of
/// libpng, because libpng reports a bad file on standard error itself. `bytes` has passed png_header(), and the caller
/// accepts the size found there. Error(bad_input) naming `where`: wrong checksums, too few or too many texels, an index
/// beyond the palette.
Image png_pixels(const std::string& where, std::span<const uint8_t> bytes);

/// Throws what png_pixels() would, in the memory of some rows.
void check_png_pixels(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
