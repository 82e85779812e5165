#include "shading/blend/blend_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/blend/blend_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once per SIMD target from blend_pass_kernel.cpp.
namespace trueshade::HWY_NAMESPACE {
decltype(trueshade::blend_tile) blend_tile_simd;
}  // namespace trueshade::HWY_NAMESPACE

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(blend_tile_simd);

void blend_tile(const LightVolumeDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(blend_tile_simd)(draws, surface, tied, rect, clear, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
