#include "raster/visibility/visibility.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void draw_visibility(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                     RasterCounts& counts) {
  kernel<draw_visibility>()(in, rect, culling, out, counts);
}

void draw_visibility_upon(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& out,
                          RasterCounts& counts) {
  kernel<draw_visibility_upon>()(in, rect, culling, out, counts);
}

void passing_fragments(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                       std::vector<DepthFragment>& out) {
  kernel<passing_fragments>()(in, rect, culling, visible, out);
}

void fragments_at_equal_depth(const TileDraws& in, const TileRect& rect, bool culling, VisibilityTile& visible,
                              std::vector<DepthFragment>& out) {
  kernel<fragments_at_equal_depth>()(in, rect, culling, visible, out);
}

void clip_corners(const TileDraws& in, uint32_t position, uint32_t triangle, ClipVertex v[3]) {
  kernel<clip_corners>()(in, position, triangle, v);
}
}  // namespace trueshade
