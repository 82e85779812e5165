#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"

namespace trueshade {

/// The texels of a PNG of any colour type, depth and interlacing: rgba16 where its channels have 16 bits, rgba8
/// otherwise. Codes are as they are stored, those of fewer than 8 bits widened: no gamma, no profile is applied. Grey
/// is spread over R, G and B; alpha is that of the file, of its palette or of the colour that stands for transparency,
/// else
/// 1. Our own, because libpng reports a bad file on standard error itself. `bytes` has passed png_header() and its size
/// is one the caller accepts. Error(bad_input) naming `where`: wrong checksums, too few or many texels, an index beyond
/// the palette.
Image png_pixels(const std::string& where, std::span<const uint8_t> bytes);

}  // namespace trueshade
