#pragma once
#include <cstdint>
#include <vector>

#include "raster/clusters.h"
#include "raster/fixed_point.h"

namespace trueshade {

/// A vertex where interpolation wants it.
struct alignas(16) PlacedVertex {
  static constexpr uint32_t kBias = uint32_t(1) << 31;
  /// Window position relative to the tile's first sample, in 1/256 pixel, plus kBias: y above, x below, so that they
  /// compare in canonical order.
  uint64_t key;
  double u;  ///< 1 / w

  double x() const { return double(int32_t(uint32_t(key) ^ kBias)); }
  double y() const { return double(int32_t(uint32_t(key >> 32) ^ kBias)); }
};

/// What is interpolated of a vertex, in the order of kRecordStream (surfaces.h): what all pixels want, and its colour.
struct alignas(32) VertexRecord {
  static constexpr int kValues = 8;
  float value[kValues];
};
struct alignas(16) VertexColor {
  float value[4];
};

/// Vertices are named by four times their place, so that the place of what they have is one address.
inline constexpr uint32_t kVertexStep = 4;
template <class T>
const T& vertex_at(const T* first, uint32_t vertex) {
  return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + vertex * (sizeof(T) / kVertexStep));
}
static_assert(3 * kMaxTilePixels * kVertexStep <= UINT16_MAX);

/// A triangle that is seen in a tile.
struct VisibleTriangle {
  uint16_t vertex[3];  ///< for vertex_at(); canonical order, as submitted where it needs care
  uint16_t careful;    ///< 1 or 0
};

/// A cluster of which a triangle is seen.
struct VisibleCluster {
  uint32_t position;                   ///< in the tile's list
  uint32_t object, material;           ///< index + 1
  uint32_t first_vertex;               ///< of its vertices in VisibleTriangles
  uint32_t first_triangle, triangles;  ///< in VisibleTriangles
  uint64_t used;                       ///< a bit for each of its vertices that a visible triangle has
  const uint8_t* corner[3];            ///< cluster-local vertex of each triangle's corner
};

/// The triangles that are seen in a tile and the vertices they have: scratch of resolve_surfaces(), kept between tiles.
/// A triangle's place is its cluster's times kPlaces plus its own in that.
struct VisibleTriangles {
  static constexpr uint32_t kPlaces = 128;
  static_assert(kPlaces >= kClusterTriangles);

  std::vector<uint32_t> slot_of;  ///< cluster by position in the tile's list, plus 1; 0 where none, kNoSlot: not seen
  std::vector<VisibleCluster> cluster;  ///< the first stands for nothing
  uint32_t clusters;
  std::vector<uint8_t> mark;    ///< by place: seen or not. All 0 between tiles
  std::vector<uint16_t> index;  ///< by place: into `triangle`, where seen
  VisibleTriangle triangle[kMaxTilePixels];
  std::vector<PlacedVertex> placed;
  std::vector<VertexRecord> record;
  std::vector<VertexColor> color;
  alignas(64) uint32_t place[kMaxTilePixels];  ///< of each pixel's triangle

  static constexpr uint32_t kNoSlot = ~0u;
  enum Seen : uint8_t { one, some, many };  ///< triangles; many: more than pay to be told apart, none of them careful
  struct Block {
    uint16_t covered;  ///< a bit a pixel
    Seen seen;
  } block[kMaxTilePixels / kBlockPixels];
};

}  // namespace trueshade
