#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raster/triangles/clip.h"
#include "raster/clusters/clusters.h"
#include "raster/triangles/triangle_setup.h"
#include "raster/view.h"
#include "raster/visibility/visibility.h"

namespace trueshade {

/// A triangle, or a piece of a clipped one, that face culling leaves; in the window, relative to its corner (0, 0).
struct PlacedTriangle {
  static constexpr int32_t kUsual = -1, kWide = -2;
  WindowTriangle window;
  uint32_t instance;
  int32_t turned;  ///< into PlacedChunk::turned: what to draw instead; kWide: leaves the vectors' range
};

/// A triangle that may touch a tile.
struct TilePlace {
  uint32_t triangle;       ///< of the chunk
  float near;              ///< no depth of it that is compared is less, but under an offset
  uint8_t x0, y0, x1, y1;  ///< blocks of the tile that its box touches, inclusive
};

/// The triangles of some instances, and for each tile those that may touch it, in order of submission.
struct PlacedChunk {
  std::vector<PlacedTriangle> triangles;
  std::vector<std::array<ClipVertex, 3>> turned;  ///< triangles of whose fan snapping has turned a piece over
  std::vector<uint32_t> first;                    ///< a tile's are list[first[tile]] to list[first[tile + 1]]
  std::vector<TilePlace> list;
};

/// A scene of large opaque triangles that share tiles with few others: each is transformed, clipped, snapped and culled
/// once, not once in each tile that its cluster touches. Untextured.
struct PlacedScene {
  int tile, tiles_x, tiles_y;
  std::vector<PlacedChunk> chunks;  ///< of ascending instances

  int tiles() const { return tiles_x * tiles_y; }
  bool empty(int tile) const;  ///< no triangle touches it
};

/// Of the instances [first, end): some 100 bytes for each triangle and tile that it touches.
PlacedScene place_scene(const Scene& scene, const ClusteredScene& clusters, const View& view,
                        const GeometryState& state, uint32_t first, uint32_t end, int tile, int threads);

/// Draws a tile upon what `out` holds: depths of surfaces drawn before, and as ids index + 1 of instances, 0 of other
/// scenes. `culling`, `fast_paths`: as in draw_visibility() and TileDraws.
void draw_placed(const PlacedScene& placed, const View& view, const GeometryState& state, int tile, bool culling,
                 bool fast_paths, VisibilityTile& out);

/// A tile of a grid of tiles that begins at the window's (0, 0).
TileRect tile_rect(const WindowTransform& window, int size, int tiles_x, int tile);

}  // namespace trueshade
