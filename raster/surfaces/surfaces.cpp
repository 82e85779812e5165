#include "raster/surfaces/surfaces.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void resolve_surfaces(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                      const VisibilityTile& visible, UvPlanes uv, VisibleVertices& work, SurfaceTile& out) {
  kernel<resolve_surfaces>()(in, rect, planes, model, visible, uv, work, out);
}

void positions_from_depth(const View& view, const TileRect& rect, const float* depth, SurfaceTile& out) {
  kernel<positions_from_depth>()(view, rect, depth, out);
}
}  // namespace trueshade
