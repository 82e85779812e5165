#include "shading/output/texels.h"

#include <algorithm>
#include <cstring>

#include "core/simd/dispatch.h"

namespace trueshade {
void store_texels(const TexelSource& source, const TileRect& rect, HalfRound half_round, Image& image) {
  kernel<store_texels>()(source, rect, half_round, image);
}

void fetch_texels(const TileRect& rect, const Image& image) {
  constexpr size_t kLine = 64;
  const int width = std::min(rect.size, image.width - rect.x), height = std::min(rect.size, image.height - rect.y);
  for (int y = 0; y < height; ++y) {
    const uint8_t* const row = image.texel(rect.x, image.height - 1 - rect.y - y);
    const uint8_t* const end = row + size_t(width) * size_t(info(image.format).bytes_per_texel());
    for (const uint8_t* line = row; line < end; line += kLine) __builtin_prefetch(line, 1);
    __builtin_prefetch(end - 1, 1);
  }
}
}  // namespace trueshade
