#pragma once
// What must not change a frame: each check draws it again, another way, and holds every plane to the first bit for bit.
#include "tests/raster/random_frame.h"

namespace trueshade::testing {

/// On every SIMD target, tile size and thread count, with and without culling, tiles shuffled.
void check_executions_alike(const Scene& scene, const Pipeline& pipeline);

/// By the general paths, and by the fast ones in every way of the check above.
void check_general_alike(const Scene& scene, const Pipeline& pipeline);

/// With every triangle begun by another of its vertices. Planes interpolated flat would mean another vertex then.
void check_turned_alike(Random& random, Scene scene, const Pipeline& pipeline, const Execution& execution);

/// Moved with its viewport by (64, 32) pixels.
void check_moved_alike(const Scene& scene, Pipeline pipeline, const Execution& execution);

/// The same pipeline with smooth planes for flat ones.
Pipeline without_flat(Pipeline pipeline);

}  // namespace trueshade::testing
