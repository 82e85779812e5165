#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"

namespace trueshade {

/// Which numbers of bits a channel may have.
enum class PngDepths : uint8_t { of_8, of_8_or_16 };

/// The texels of a PNG without interlacing as rgba8 or rgba16, codes as they are stored: no gamma, no profile is
/// applied. Grey is spread over R, G and B, and alpha is 1 where the file has none. Our own, because libpng reports a bad
/// file on standard error itself. `bytes` has passed png_header() and its size is one the caller accepts.
/// Error(bad_input) naming `where`: another kind of PNG, wrong checksums, too few or many texels.
Image png_pixels(const std::string& where, std::span<const uint8_t> bytes, PngDepths depths);

}  // namespace trueshade
