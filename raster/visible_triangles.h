#pragma once
#include <bit>
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

/// What is interpolated of a vertex, in the order of kRecordStream (surfaces.h), and what finds no place there.
struct alignas(32) VertexRecord {
  static constexpr int kValues = 8;
  float value[kValues];
};
struct alignas(16) VertexRest {
  static constexpr int kValues = 4;
  float value[kValues];
};

/// Vertices are named by four times their place, so that the place of what they have is one address.
inline constexpr uint32_t kVertexStep = 4;
template <class T>
const T& vertex_at(const T* first, uint32_t vertex) {
  return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + vertex * (sizeof(T) / kVertexStep));
}
static_assert(3 * kMaxTilePixels * kVertexStep <= UINT16_MAX);

/// A cluster of which a triangle is seen.
struct VisibleCluster {
  uint32_t position;          ///< in the tile's list
  uint32_t object, material;  ///< index + 1
  uint32_t first_vertex;      ///< of its vertices in VisibleTriangles, for vertex_at()
  uint64_t used;              ///< a bit for each of its vertices that a visible triangle has
  const uint8_t* corner[3];   ///< cluster-local vertex of each triangle's corner
};

/// A triangle that is seen: its place is its cluster's times kTrianglePlaces plus its own in that; its corners are
/// cluster-local vertices, a byte each, the first lowest.
inline constexpr uint32_t kTrianglePlaces = 128;
static_assert(kTrianglePlaces >= kClusterTriangles);
struct SeenTriangle {
  uint32_t place, corners;
};

/// Pixels of a block that see one triangle.
struct SeenRun {
  uint16_t block, pixels;  ///< a bit a pixel
  SeenTriangle triangle;
};

/// The triangles that are seen in a tile and the vertices they have: scratch of resolve_surfaces(), kept between tiles.
struct VisibleTriangles {
  static constexpr uint32_t kNoSlot = ~0u;
  std::vector<uint32_t> slot_of;  ///< cluster by position in the tile's list, plus 1; 0 where none, kNoSlot: not seen
  std::vector<VisibleCluster> cluster;  ///< the first stands for nothing
  uint32_t clusters;
  std::vector<uint8_t> used;  ///< kClusterVertices a cluster: 1 where a vertex is used. All 0 between tiles
  std::vector<PlacedVertex> placed;
  std::vector<VertexRecord> record;
  std::vector<VertexRest> rest;

  uint16_t covered[kMaxTilePixels / kBlockPixels];  ///< of each block, a bit a pixel
  SeenRun run[kMaxTilePixels];                      ///< of blocks that see few triangles
  uint32_t runs;
  static constexpr uint16_t kNoRun = UINT16_MAX;
  std::vector<uint16_t> first_run;               ///< of a triangle's long runs, by place. All kNoRun between tiles
  uint16_t next_run[kMaxTilePixels];             ///< of the same triangle, by run
  uint32_t chain[kMaxTilePixels];                ///< places of the triangles that have long runs
  uint16_t many[kMaxTilePixels / kBlockPixels];  ///< blocks that see more, none of them careful
  uint32_t manys;
  alignas(64) uint32_t place[kMaxTilePixels], corners[kMaxTilePixels];  ///< of the triangles their pixels see
};

/// Vertex of a cluster, for vertex_at(): used ones lie side by side.
inline uint32_t vertex_of(const VisibleCluster& cluster, uint32_t corner) {
  return cluster.first_vertex + kVertexStep * uint32_t(std::popcount(cluster.used & ((uint64_t(1) << corner) - 1)));
}

}  // namespace trueshade
