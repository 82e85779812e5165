#include "raster/surfaces/surfaces.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void resolve_surfaces(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                      const VisibilityTile& visible, UvPlanes uv, VisibleVertices& work, SurfaceTile& out) {
  out.x = rect.x + int(in.view.window.corner[0]), out.y = rect.y + int(in.view.window.corner[1]);
  kernel<resolve_surfaces>()(in, rect, planes, model, visible, uv, work, out);
}

void positions_from_depth(const View& view, const TileRect& rect, const float* depth, SurfaceTile& out) {
  kernel<positions_from_depth>()(view, rect, depth, out);
}
}  // namespace trueshade
