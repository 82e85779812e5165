#pragma once
#include <cstdint>
#include <vector>

#include "raster/fixed_point.h"

namespace trueshade {

/// A vertex where interpolation wants it.
struct PlacedVertex {
  double x, y;  ///< window position relative to the tile's first sample, in 1/256 pixel
  double u;     ///< 1 / w
  double unused;
};

/// Four attributes of a vertex side by side, in the order of kQuadStream (surfaces.h).
struct alignas(16) AttributeQuad {
  float value[4];
};

/// A triangle that is seen in a tile.
struct VisibleTriangle {
  uint32_t id;
  uint32_t vertex[3];         ///< into VisibleTriangles, canonical order; as submitted where it needs care
  uint32_t object, material;  ///< index + 1
};

/// A cluster of which a triangle is seen.
struct VisibleCluster {
  uint32_t position;         ///< in the tile's list
  uint32_t first;            ///< of its vertices in VisibleTriangles
  uint64_t used;             ///< a bit for each of its vertices that a visible triangle has
  const uint8_t* corner[3];  ///< cluster-local vertex of each triangle's corner
  uint32_t object, material;
};

/// The triangles that are seen in a tile and the vertices they have: scratch of resolve_surfaces(), kept between tiles.
struct VisibleTriangles {
  VisibleTriangle triangle[kMaxTilePixels];
  uint32_t cluster_of[kMaxTilePixels];  ///< of each triangle
  uint32_t triangles = 0;
  std::vector<VisibleCluster> cluster;
  std::vector<PlacedVertex> placed;
  std::vector<int64_t> key;  ///< of each vertex, y * 2^32 + x: the canonical order
  std::vector<AttributeQuad> quad[3];
  alignas(64) uint16_t of_pixel[kMaxTilePixels];  ///< where covered

  enum Seen : uint8_t { one, some, many };  ///< triangles; many: more than pay to be told apart, none of them careful
  struct Block {
    uint16_t covered;  ///< a bit a pixel
    Seen seen;
  } block[kMaxTilePixels / kBlockPixels];

  static constexpr uint32_t kRecent = 1024;
  struct {
    uint32_t id, triangle;
  } recent[kRecent];              ///< triangles found, by a few bits of their ids; what is pushed out is listed again
  std::vector<uint32_t> slot_of;  ///< cluster by position in the tile's list, plus 1; 0: not seen
};

}  // namespace trueshade
