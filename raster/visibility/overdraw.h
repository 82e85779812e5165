#pragma once
#include <cstdint>

#include "raster/visibility/visibility.h"

namespace trueshade {

/// How many fragments each pixel of a tile gets: covered samples of the triangles that face culling leaves, before the
/// depth test. Depends on nothing but scene and pipeline.
///   counts: in tile_index() order; set, not added to
void count_fragments(const TileDraws& in, const TileRect& rect, uint32_t* counts);

}  // namespace trueshade
