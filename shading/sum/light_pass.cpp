#include "shading/sum/light_pass.h"

#include "core/simd/dispatch.h"
#include "shading/sum/program_tile.h"

namespace trueshade {
void light_tile(const SurfaceTile& surface, int tile, const LightTable& lights, const LightClusters& clusters,
                const LightModel& model, const float clear[4], const LightShortcuts& shortcuts, LightLists& work,
                ColorTile& out, LightCounts& counts) {
  if (lights.program != nullptr)
    return program_tile({surface, tile, lights, model, clear, shortcuts, work, out, counts});
  kernel<light_tile>()(surface, tile, lights, clusters, model, clear, shortcuts, work, out, counts);
}
}  // namespace trueshade
