#include "shading/blend/transparent_blend.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void encode_colors(const BlendTarget& target, int pixels, ColorTile& color) {
  kernel<encode_colors>()(target, pixels, color);
}

void blend_layer(const BlendState& state, const BlendTarget& target, const SurfaceTile& layer, const ColorTile& source,
                 int pixels, ColorTile& stored) {
  kernel<blend_layer>()(state, target, layer, source, pixels, stored);
}

void blend_albedo(const BlendState& state, const BlendTarget& plane, const SurfaceTile& layer, int pixels,
                  SurfaceTile& surface) {
  kernel<blend_albedo>()(state, plane, layer, pixels, surface);
}
}  // namespace trueshade
