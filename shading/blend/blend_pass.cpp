#include "shading/blend/blend_pass.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void blend_tile(const LightVolumeDraws& draws, const SurfaceTile& surface, const TiedFragments* tied,
                const TileRect& rect, const float clear[4], BlendWork& work, ColorTile& out, LightCounts& counts) {
  kernel<blend_tile>()(draws, surface, tied, rect, clear, work, out, counts);
}
}  // namespace trueshade
