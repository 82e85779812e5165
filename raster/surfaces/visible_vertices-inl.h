// Finds the triangle of every pixel of a tile and transforms the vertices of the clusters that are seen. Included once
// per SIMD target. docs/arithmetic.md sections 2 and 4.
#if defined(TRUESHADE_RASTER_SURFACES_VISIBLE_VERTICES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_RASTER_SURFACES_VISIBLE_VERTICES_INL_H_
#undef TRUESHADE_RASTER_SURFACES_VISIBLE_VERTICES_INL_H_
#else
#define TRUESHADE_RASTER_SURFACES_VISIBLE_VERTICES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "raster/surfaces/surface_task.h"
#include "raster/surfaces/world_vertices-inl.h"
#include "raster/triangles/vertex_stage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The values of some vertices; 0 where the mesh has no such stream.
inline void copy_stream(const FloatStream& from, const uint32_t* vertex, int count, float* to) {
  if (from.empty()) return void(std::fill_n(to, count, 0.0f));
  const float* value = from.data();
  for (int i = 0; i < count; ++i) to[i] = value[vertex[i]];
}

/// Copies a cluster's object-space attributes to `at` and on.
inline void copy_attributes(const SurfaceTask& task, const Mesh& mesh, const ClusteredMesh& clusters,
                            const Cluster& cluster, size_t at) {
  VisibleVertices& work = task.work;
  const uint32_t* vertex = &clusters.vertex[cluster.first_vertex];
  const int count = cluster.vertices;
  for (size_t c = 0; c < 3; ++c) {
    std::copy_n(&clusters.position[c][cluster.first_vertex], count, &work.stream[size_t(kPosition) + c][at]);
  }
  for (int i = 0; i < count; ++i) {
    const size_t of_cluster = cluster.first_vertex + size_t(i);
    for (int c = 0; c < 3; ++c) work.stream[kNormal + c][at + size_t(i)] = surface_value(clusters, of_cluster, c);
    for (int c = 0; c < 4; ++c) work.stream[kAlbedo + c][at + size_t(i)] = surface_value(clusters, of_cluster, 3 + c);
  }
  for (int set = 0; set < task.in.view.maps.uv_sets && task.reads_uv; ++set)
    for (size_t c = 0; c < 2; ++c)
      copy_stream(mesh.uv_set(size_t(set))[c], vertex, count, &work.stream[size_t(uv_stream(set)) + c][at]);
  for (size_t c = 0; c < 4 && task.in.view.maps.tangents; ++c)
    copy_stream(mesh.tangent[c], vertex, count, &work.stream[kVertexTangent + c][at]);
}

/// Transforms the vertices of a seen cluster, given by its position in the tile's list, into the 64 of a slot.
inline void fill_slot(const SurfaceTask& task, uint32_t position, int32_t slot) {
  const TileDraws& in = task.in;
  VisibleVertices& work = task.work;
  const ClusterDraw& draw = in.draws[in.list[position]];
  const Instance& instance = in.scene.instances[draw.instance];
  const InstanceTransform& transform = in.view.instances[draw.instance];
  const ClusteredMesh& clusters = in.clusters.meshes[instance.mesh];
  const Cluster& cluster = clusters.clusters[draw.cluster];
  const size_t at = size_t(slot) * kClusterVertices;
  if (work.x.size() < at + kClusterVertices) {
    const size_t grown = std::max(2 * work.x.size(), at + kClusterVertices);
    work.x.resize(grown), work.y.resize(grown), work.u.resize(grown);
  }
  for (int c = 0; c < task.streams(); ++c)
    if (work.stream[c].size() < work.x.size()) work.stream[c].resize(work.x.size());
  WindowVertices window;
  window_vertices(clusters, cluster, transform, in.view.window, sample_origin(task.rect.x, task.rect.y), draw.no_clip,
                  window);
  std::copy_n(window.x, cluster.vertices, &work.x[at]);
  std::copy_n(window.y, cluster.vertices, &work.y[at]);
  std::copy_n(window.u, cluster.vertices, &work.u[at]);
  copy_attributes(task, in.scene.meshes[instance.mesh], clusters, cluster, at);
  const D32 d;
  const bool tangents = in.view.maps.tangents, mirrored = tangents && mirrors(instance.world_from_object);
  for (size_t i = at; i < at + cluster.vertices; i += hn::Lanes(d)) {
    V32 object[6], world[6];
    for (size_t c = 0; c < 6; ++c) object[c] = hn::LoadU(d, &work.stream[c][i]);
    to_world(transform, task.planes.unit_normals, object, object + 3, world);
    for (size_t c = 0; c < 6; ++c) hn::StoreU(world[c], d, &work.stream[c][i]);
    if (!tangents) continue;
    for (size_t c = 0; c < 4; ++c) object[c] = hn::LoadU(d, &work.stream[kVertexTangent + c][i]);
    tangents_to_world(transform, mirrored, object, world);
    for (size_t c = 0; c < 4; ++c) hn::StoreU(world[c], d, &work.stream[kVertexTangent + c][i]);
  }
}

/// The slot of a cluster, given by its position in the tile's list. Its vertices are transformed when it is first seen.
inline int32_t slot_of(const SurfaceTask& task, uint32_t position) {
  VisibleVertices& work = task.work;
  int32_t& slot = work.slot_of[position];
  if (slot >= 0) return slot;
  slot = int32_t(work.seen.size());
  const ClusterDraw& draw = task.in.draws[task.in.list[position]];
  const Instance& instance = task.in.scene.instances[draw.instance];
  const ClusteredMesh& mesh = task.in.clusters.meshes[instance.mesh];
  const uint32_t first = mesh.clusters[draw.cluster].first_triangle;
  work.seen.push_back({position,
                       draw.instance + 1,
                       instance.material + 1,
                       {&mesh.corner[0][first], &mesh.corner[1][first], &mesh.corner[2][first]}});
  fill_slot(task, position, slot);
  return slot;
}

/// Fills the planes of coverage, object and material, and gives every pixel the three vertices of its triangle.
inline void find_corners(const SurfaceTask& task) {
  VisibleVertices& work = task.work;
  SurfaceTile& out = task.out;
  const int pixels = task.pixels();
  work.slot_of.resize(std::max(work.slot_of.size(), task.in.list.size()), -1);
  work.seen.clear();
  for (auto& corner : work.corner) corner.assign(size_t(pixels), 0);
  out.covered_pixels = 0;
  for (int i = 0; i < pixels; ++i) {
    const uint32_t id = task.visible.id[i];
    out.covered[i] = id == 0 ? 0 : -1;
    out.covered_pixels += id != 0;
    out.object[i] = out.material[i] = 0;
    if (id == 0) continue;
    const int32_t slot = slot_of(task, id_position(id));
    const SeenCluster& seen = work.seen[size_t(slot)];
    const uint32_t first = uint32_t(slot) * uint32_t(kClusterVertices);
    for (size_t k = 0; k < 3; ++k) work.corner[k][size_t(i)] = first + seen.corner[k][id_triangle(id)];
    out.object[i] = seen.object;
    out.material[i] = seen.material;
  }
  for (const SeenCluster& seen : work.seen) work.slot_of[seen.position] = -1;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
