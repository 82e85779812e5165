#pragma once
#include <cstdint>

#include "core/image.h"
#include "raster/visibility/visibility.h"

namespace trueshade {

/// What the texels of a tile are made of: planes in tile_index() order, 64-byte aligned, a float a pixel, or the bits
/// of an integer where the format has integers.
struct TexelSource {
  const float* plane[4] = {};        ///< R, G, B, A; null: `constant`
  float constant[4] = {};            ///< where there is no plane
  const int32_t* covered = nullptr;  ///< -1, or 0 where all channels are 0; null: -1 everywhere
  bool halved = false;               ///< (v + 1) / 2 is stored, of constants too
  bool coded = false;                ///< planes of fixed-point formats hold codes, not values
};

/// Rounds a tile's channels to the image's format (docs/arithmetic.md section 7) and writes them into their place,
/// all that the image has of the tile. Rows of the image run from the top down while the tile's y points up. Exact: the
/// bits of core/half.h and core/small_float.h on every SIMD target.
void store_texels(const TexelSource& source, const TileRect& rect, HalfRound half_round, Image& image);

/// Asks for the image's lines that store_texels() is going to write, so that it need not wait for them.
void fetch_texels(const TileRect& rect, const Image& image);

}  // namespace trueshade
