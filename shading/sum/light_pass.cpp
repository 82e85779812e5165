#include "shading/sum/light_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sum/light_pass.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Compiled once per SIMD target from light_pass_kernel.cpp.
namespace trueshade::HWY_NAMESPACE {
decltype(trueshade::light_tile) light_tile_simd;
}  // namespace trueshade::HWY_NAMESPACE

#if HWY_ONCE
namespace trueshade {
HWY_EXPORT(light_tile_simd);

void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightClusters& clusters,
                const LightModel& model, const float clear[4], const LightShortcuts& shortcuts, LightLists& work,
                ColorTile& out, LightCounts& counts) {
  HWY_DYNAMIC_DISPATCH(light_tile_simd)
  (surface, tile, lights, clusters, model, clear, shortcuts, work, out, counts);
}
}  // namespace trueshade
#endif  // HWY_ONCE
