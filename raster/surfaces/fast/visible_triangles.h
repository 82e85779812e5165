#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "raster/clusters/clusters.h"
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
const T& vertex_at(const T* first, size_t vertex) {
  return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + vertex * (sizeof(T) / kVertexStep));
}
static_assert(3 * kMaxTilePixels * kVertexStep <= UINT16_MAX);

/// A cluster of which a triangle is seen.
struct alignas(64) VisibleCluster {
  uint8_t mark[kClusterVertices];  ///< 1 where a visible triangle has a vertex, until `used` is set; then 0
  const uint8_t* corner[3];        ///< cluster-local vertex of each triangle's corner
  uint64_t used;                   ///< a bit for each of its vertices that a visible triangle has
  uint32_t position;               ///< in the tile's list
  uint32_t object, material;       ///< index + 1
  uint32_t first_vertex;           ///< of its vertices in VisibleTriangles, for vertex_at()
};

/// A triangle that is seen: its place is its cluster's times kTrianglePlaces plus its own in that; its corners are
/// cluster-local vertices, a byte each, the first lowest.
inline constexpr uint32_t kTrianglePlaces = 128;
static_assert(kTrianglePlaces >= kClusterTriangles);
struct SeenTriangle {
  uint32_t place, corners;
};

/// The cluster of a triangle by its place, of which the cluster's own in bytes is a part.
template <class T>
T& cluster_at(T* first, uint32_t place) {
  static_assert(sizeof(T) == kTrianglePlaces);
  return *reinterpret_cast<T*>(uintptr_t(first) + (place & ~(kTrianglePlaces - 1)));
}

/// Pixels of a block that see one triangle.
struct SeenRun {
  uint16_t block, pixels;  ///< a bit a pixel
  SeenTriangle triangle;
};

/// The triangles that are seen in a tile and the vertices they have: scratch of resolve_surfaces(), kept between tiles.
struct VisibleTriangles {
  static constexpr uint32_t kNoSlot = ~0u;
  /// Place of a cluster's first triangle by position in the tile's list, plus 1; 0 where none, kNoSlot: not seen.
  std::vector<uint32_t> slot_of;
  std::vector<VisibleCluster> cluster;  ///< the first stands for nothing
  uint32_t clusters;
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

/// Vertex of a cluster, for vertex_at(), by the complement of a corner, whose upper bits are ignored: used ones, of
/// which it is one, lie side by side.
inline uint32_t vertex_of(const VisibleCluster& cluster, uint32_t complement) {
  static_assert(kClusterVertices == 64);
  return cluster.first_vertex + kVertexStep * uint32_t(std::popcount(cluster.used << (complement & 63))) - kVertexStep;
}

}  // namespace trueshade
