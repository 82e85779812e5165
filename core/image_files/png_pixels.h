#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"

namespace trueshade {

/// Which colour types are taken: RGBA of 8 or 16 bits a channel, or any of 8.
enum class PngKinds : uint8_t { rgba, any };

/// The texels of a PNG without interlacing as rgba8 or rgba16, codes as they are stored: no gamma, no profile is
/// applied. Our own, because libpng reports a bad file on standard error itself. `bytes` has passed png_header() and
/// its size is one the caller accepts. Error(bad_input) naming `where`: another kind of PNG, wrong checksums, too few
/// or many texels.
Image png_pixels(const std::string& where, std::span<const uint8_t> bytes, PngKinds kinds = PngKinds::rgba);

}  // namespace trueshade
