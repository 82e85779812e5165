#pragma once
#include <algorithm>

#include "raster/view.h"

namespace trueshade {

/// A square of pixels and which of them may be drawn; window coordinates, y up.
struct TileRect {
  int x, y;      ///< lower left pixel in the window
  int size;      ///< 8, 16, 32, 48 or 64
  int limit[4];  ///< x0, y0, x1, y1 in the tile, half open: inside viewport and image
};

/// The tile `index` of a grid of tiles that begins at the window's pixel (0, 0), row by row.
inline TileRect tile_rect(const WindowTransform& window, int size, int tiles_x, int index) {
  const int x = index % tiles_x * size, y = index / tiles_x * size;
  const auto in_tile = [size](int v) { return std::clamp(v, 0, size); };
  return {x, y, size, {in_tile(window.x0 - x), in_tile(window.y0 - y), in_tile(window.x1 - x), in_tile(window.y1 - y)}};
}

}  // namespace trueshade
