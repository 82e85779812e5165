#pragma once
#include <cstring>

#include "core/image.h"

namespace trueshade {

/// An image of 1x1 with the texel at column x and row y, counted from the top left.
inline Image one_pixel(const Image& image, int x, int y) {
  Image out(1, 1, image.format);
  std::memcpy(out.texels.data(), image.texel(x, y), out.texels.size());
  return out;
}

}  // namespace trueshade
