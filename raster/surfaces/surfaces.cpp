#include "raster/surfaces/surfaces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/surfaces/surfaces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once per SIMD target from surfaces_kernel.cpp.
namespace trueshade::HWY_NAMESPACE {
decltype(trueshade::resolve_surfaces) resolve_surfaces_simd;
}  // namespace trueshade::HWY_NAMESPACE

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(resolve_surfaces_simd);

void resolve_surfaces(const TileDraws& in, const TileRect& rect, const GBufferState& planes, const LightModel& model,
                      const VisibilityTile& visible, bool need_uv, VisibleVertices& work, SurfaceTile& out) {
  HWY_DYNAMIC_DISPATCH(resolve_surfaces_simd)(in, rect, planes, model, visible, need_uv, work, out);
}
}  // namespace trueshade
#endif  // HWY_ONCE
