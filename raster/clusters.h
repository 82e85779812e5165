#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace trueshade {

inline constexpr int kClusterVertices = 64;
inline constexpr int kClusterTriangles = 126;
inline constexpr size_t kCornerSlack = 64;  ///< zeros after the last triangle's corners, so that vectors may read on

/// A run of consecutive triangles of a mesh that share at most 64 vertices: the unit of culling and binning.
struct Cluster {
  uint32_t first_vertex;    ///< into ClusteredMesh's vertex streams; a multiple of 16
  uint32_t first_triangle;  ///< of the mesh, in submission order; also into ClusteredMesh::corner
  uint16_t vertices;        ///< 1..64; the streams go on with copies of the last vertex up to a multiple of 16
  uint16_t triangles;       ///< 1..126
};

/// Object-space boxes, a lane each; vectors may read on past the last.
struct ClusterBoxes {
  std::array<std::vector<float>, 3> center, half_size;  ///< half sizes rounded up
};

/// Memory that begins with a cache line and, where it is much, lies in large pages if the system has them: a cluster is
/// read at a dozen places of as many pages.
void* allocate_stream(size_t bytes);
void free_stream(void* memory, size_t bytes);

template <class T>
struct StreamAllocator {
  using value_type = T;
  StreamAllocator() = default;
  template <class U>
  StreamAllocator(const StreamAllocator<U>&) {}
  T* allocate(size_t count) { return static_cast<T*>(allocate_stream(count * sizeof(T))); }
  void deallocate(T* memory, size_t count) { free_stream(memory, count * sizeof(T)); }
  template <class U>
  bool operator==(const StreamAllocator<U>&) const {
    return true;
  }
};
template <class T>
using StreamVector = std::vector<T, StreamAllocator<T>>;

/// One number of 16 vertices.
struct alignas(64) VertexLine {
  float value[16];
};

struct ClusteredMesh {
  std::vector<Cluster> clusters;
  ClusterBoxes boxes;                           ///< of each cluster, then of the mesh
  std::array<StreamVector<float>, 3> position;  ///< object space, a cluster's vertices side by side
  /// Of each 16 vertices `surface_lines` lines side by side: normal x, y, z in object space and, where the mesh has
  /// colours, r, g, b, a. What is read of a cluster lies in one place, not at one place of seven streams.
  StreamVector<VertexLine> surface;
  int surface_lines;
  std::vector<uint32_t> vertex;                 ///< the mesh's vertex that each of them is
  std::array<StreamVector<uint8_t>, 3> corner;  ///< cluster-local vertex of each triangle's corner
};

/// Where the lines of the 16 vertices from `vertex` on begin.
inline const VertexLine* surface_of(const ClusteredMesh& mesh, size_t vertex) {
  return mesh.surface.data() + vertex / 16 * size_t(mesh.surface_lines);
}

struct ClusteredScene {
  std::vector<ClusteredMesh> meshes;  ///< one per Scene::meshes
};

ClusteredMesh cluster_mesh(const Mesh& mesh);
ClusteredScene cluster_scene(const Scene& scene);

}  // namespace trueshade
