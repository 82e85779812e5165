#pragma once
#include <cstdint>
#include <span>

#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// Clip coordinates x, y, z, w of three vertices.
struct ClipTriangle {
  float vertex[3][4];
};

/// How often each pixel is covered: the triangles go through clipping, snapping, setup and coverage exactly as in the
/// geometry pass, but each covered sample is counted instead of tested.
/// Snapped as `profile` says.
/// Of `execution` the tile size and the SIMD target count; one thread does the work.
///   counts: width * height, row 0 at window y = 0; counts up from what is there
void count_coverage(std::span<const ClipTriangle> triangles, const GeometryState& state, int width, int height,
                    const Execution& execution, std::span<uint16_t> counts,
                    NumericProfile profile = NumericProfile::ideal);

}  // namespace trueshade
