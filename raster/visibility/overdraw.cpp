#include "raster/visibility/overdraw.h"

#include <algorithm>

#include "core/simd/dispatch.h"

namespace trueshade {
void count_fragments(const TileDraws& in, const TileRect& rect, uint32_t* counts) {
  kernel<count_fragments>()(in, rect, counts);
}
}  // namespace trueshade
