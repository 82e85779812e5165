#include "raster/light_geometry/transformed_mesh.h"

#include "core/simd/dispatch.h"

namespace trueshade {

void transform_mesh(const LightMesh& mesh, const Light& light, const View& view, const WindowTransform& window,
                    const int origin_fx[2], TransformedMesh& out) {
  kernel<transform_mesh>()(mesh, light, view, window, origin_fx, out);
}

void count_mesh(const LightMesh& mesh, const TransformedMesh& placed, const GeometryState& state,
                const WindowTransform& window, const TileRect& rect, uint16_t* counts) {
  kernel<count_mesh>()(mesh, placed, state, window, rect, counts);
}

}  // namespace trueshade
