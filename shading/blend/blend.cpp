#include "shading/blend/blend.h"

#include "core/simd/dispatch.h"

namespace trueshade {
void blend_pixels(const BlendState& state, const BlendTarget& target, const float* const source[4],
                  float* const stored[4], size_t count) {
  kernel<blend_pixels>()(state, target, source, stored, count);
}

void fetch_pixels(const BlendTarget& target, const float* const stored[4], float* const values[4], size_t count) {
  kernel<fetch_pixels>()(target, stored, values, count);
}
}  // namespace trueshade
