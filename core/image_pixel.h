#pragma once
#include <cstring>

#include "core/image.h"

namespace trueshade {

/// A pixel as an image of its own; y counts from the top.
inline Image one_pixel(const Image& image, int x, int y) {
  Image out(1, 1, image.format);
  std::memcpy(out.texels.data(), image.texel(x, y), out.texels.size());
  return out;
}

}  // namespace trueshade
