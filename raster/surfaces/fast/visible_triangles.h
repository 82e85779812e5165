#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "raster/clusters/clusters.h"
#include "raster/fixed_point.h"

namespace trueshade {

/// A vertex as interpolation reads it.
struct alignas(16) VertexPosition {
  static constexpr uint32_t kBias = uint32_t(1) << 31;
  /// Window position relative to the tile's first sample, in 1/256 pixel, plus kBias: y above, x below, so that they
  /// compare in canonical order.
  uint64_t key;
  double u;  ///< 1 / w

  double x() const { return double(int32_t(uint32_t(key) ^ kBias)); }
  double y() const { return double(int32_t(uint32_t(key >> 32) ^ kBias)); }
};

/// The attributes of a vertex in the order of kRecordStream (used_vertices-inl.h): the first eight, and the rest.
struct alignas(32) VertexRecord {
  static constexpr int kValues = 8;
  float value[kValues];
};
struct alignas(16) VertexRest {
  static constexpr int kValues = 4;
  float value[kValues];
};
/// The tangent of a vertex: the streams from kVertexTangent on.
struct alignas(16) VertexTangent {
  float value[4];
};

/// Vertices are named by four times their index, so that the address of each of their records is one addition away.
/// There must be records: without any, `first` is null, and there is nothing that a reference could name.
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

/// A triangle that is seen: its index is that of its cluster times kTriangleStep plus its own index in the cluster. Its
/// corners are cluster-local vertices, a byte each, the first lowest.
inline constexpr uint32_t kTriangleStep = 128;
static_assert(kTriangleStep >= kClusterTriangles);
struct SeenTriangle {
  uint32_t index, corners;
};

/// The cluster of a triangle by the triangle's index: its upper bits are the cluster's offset in bytes.
template <class T>
T& cluster_at(T* first, uint32_t index) {
  static_assert(sizeof(T) == kTriangleStep);
  return *reinterpret_cast<T*>(uintptr_t(first) + (index & ~(kTriangleStep - 1)));
}

/// The pixels of a block that see one triangle.
struct SeenPart {
  uint16_t block, pixels;  ///< a bit a pixel
  SeenTriangle triangle;
};

/// The triangles that are seen in a tile and their vertices: scratch of resolve_by_blocks(), kept between tiles.
struct VisibleTriangles {
  static constexpr uint32_t kUnseen = ~0u;
  /// Index of a cluster's first triangle by the cluster's position in the tile's list, plus 1; 0 where there is none.
  std::vector<uint32_t> first_triangle;
  std::vector<VisibleCluster> cluster;  ///< the first stands for pixels that see nothing
  uint32_t clusters;
  std::vector<VertexPosition> position;
  std::vector<VertexRecord> record;
  std::vector<VertexRest> rest;
  std::vector<VertexTangent> tangent;  ///< where meshes have any that are read

  uint16_t covered[kMaxTilePixels / kBlockPixels];  ///< of each block, a bit a pixel
  SeenPart part[kMaxTilePixels];                    ///< of blocks that see few triangles
  uint32_t parts;
  static constexpr uint16_t kNoPart = UINT16_MAX;
  std::vector<uint16_t>
      first_part;  ///< of a triangle, by index, where it has several pixels. All kNoPart between tiles
  uint16_t next_part[kMaxTilePixels];               ///< of the same triangle, by part
  uint32_t chain[kMaxTilePixels];                   ///< the triangles that have a first part
  uint16_t crowded[kMaxTilePixels / kBlockPixels];  ///< blocks that see many triangles, none of them clipped
  uint32_t crowds;
  alignas(64) uint32_t triangle[kMaxTilePixels], corners[kMaxTilePixels];  ///< of each pixel of a crowded block
};

/// The vertex of a cluster's corner, for vertex_at(), by the complement of the corner, whose upper bits are ignored.
/// Used vertices lie side by side, and this one is used.
inline uint32_t vertex_of(const VisibleCluster& cluster, uint32_t complement) {
  static_assert(kClusterVertices == 64);
  return cluster.first_vertex + kVertexStep * uint32_t(std::popcount(cluster.used << (complement & 63))) - kVertexStep;
}

}  // namespace trueshade
