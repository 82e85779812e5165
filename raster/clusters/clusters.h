#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/array.h"
#include "core/huge_pages.h"
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
  std::array<Array<float>, 3> center, half_size;  ///< half sizes rounded up
};

/// One component of an attribute, of 16 vertices.
struct alignas(64) VertexLine {
  float value[16];
};

/// An array that is read at scattered places. It may lie in a cache file (scene_cache/).
template <class T>
using HugeArray = Array<T, HugeVector<T>>;

struct ClusteredMesh {
  Array<Cluster> clusters;
  ClusterBoxes boxes;                        ///< of each cluster, then of the mesh
  std::array<HugeArray<float>, 3> position;  ///< object space, a cluster's vertices side by side
  /// Each 16 vertices have `surface_lines` lines side by side: normal x, y, z in object space and, if the mesh has
  /// colours, r, g, b, a. So the attributes of a cluster are read from one place in memory instead of from seven.
  HugeArray<VertexLine> surface;
  int surface_lines;
  HugeArray<uint32_t> vertex;                ///< the mesh's vertex that each of them is
  std::array<HugeArray<uint8_t>, 3> corner;  ///< cluster-local vertex of each triangle's corner
  uint32_t pose = 0;                          ///< Mesh::pose of the vertices
};

/// Where the lines of the 16 vertices from `vertex` on begin.
inline const VertexLine* surface_of(const ClusteredMesh& mesh, size_t vertex) {
  return mesh.surface.data() + vertex / 16 * size_t(mesh.surface_lines);
}

/// The number of a vertex in a line: 0 to 2 of the normal, 3 to 6 of the colour, which is 1 where there is none.
inline float surface_value(const ClusteredMesh& mesh, size_t vertex, int line) {
  return line < mesh.surface_lines ? surface_of(mesh, vertex)[line].value[vertex % 16] : 1.0f;
}

/// Checks what lies in a cache file (scene_cache/) before a frame reads it.
class ClusterSource {
 public:
  virtual ~ClusterSource() = default;
  /// Of a cluster of a mesh that `instance` draws: its vertices and triangles, the texture coordinates of its vertices,
  /// and the textures of the instance's material. Error(io) where they are damaged. May be called on any thread.
  virtual void check(const Scene& scene, const Instance& instance, const ClusteredMesh& mesh,
                     const Cluster& cluster) const = 0;
  /// What camera_seeing() reads to frame a camera of ours: the positions of all meshes, and their triangles and
  /// normals where looks_at_faces() says so. Error(io) where they are damaged.
  virtual void check_for_camera(const Scene& scene) const = 0;
  virtual void check_all() const = 0;
};

struct ClusteredScene {
  std::vector<ClusteredMesh> meshes;              ///< one per Scene::meshes
  std::shared_ptr<const ClusterSource> source{};  ///< null where all is in memory
};

ClusteredMesh cluster_mesh(const Mesh& mesh);
ClusteredScene cluster_scene(const Scene& scene);

/// Clusters those meshes again that set_time() has posed since.
void cluster_posed_meshes(const Scene& scene, ClusteredScene& clusters);

}  // namespace trueshade
