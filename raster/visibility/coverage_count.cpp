#include "raster/visibility/coverage_count.h"

#include "core/fp_env.h"
#include "core/simd/dispatch.h"
#include "core/simd/simd_target.h"

namespace trueshade {
void count_coverage(std::span<const ClipTriangle> triangles, const GeometryState& state, int width, int height,
                    const Execution& execution, std::span<uint16_t> counts, NumericProfile profile) {
  const FpScope fp;
  const SimdScope simd(execution.simd);
  kernel<count_coverage>()(triangles, state, width, height, execution, counts, profile);
}
}  // namespace trueshade
