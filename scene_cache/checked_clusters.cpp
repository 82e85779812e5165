#include "scene_cache/checked_clusters.h"

#include "scenes/scene_defaults.h"

namespace trueshade {

void CheckedClusters::check(const Scene& scene, const Instance& instance, const ClusteredMesh& mesh,
                            const Cluster& cluster) const {
  constexpr size_t kLine = 16;  // vertices
  const size_t lines = (cluster.vertices + kLine - 1) / kLine;
  for (const auto& stream : mesh.position) check_part(stream, cluster.first_vertex, lines * kLine);
  for (const auto& stream : mesh.corner) check_part(stream, cluster.first_triangle, cluster.triangles);
  const auto lines_each = size_t(mesh.surface_lines);
  check_part(mesh.surface, cluster.first_vertex / kLine * lines_each, lines * lines_each);
  const Mesh& source = scene.meshes[instance.mesh];
  if (source.has_uv() || !source.more_uv.empty() || source.has_tangents()) {
    check_part(mesh.vertex, cluster.first_vertex, cluster.vertices);
    check_own_streams(source, {mesh.vertex.data() + cluster.first_vertex, cluster.vertices});
  }
  for (const TextureSlot* map : maps_of(scene.materials[instance.material]))
    if (map->used()) check_texture(scene.textures[size_t(map->texture)], size_t(map->texture));
}

void CheckedClusters::check_for_camera(const Scene& scene) const {
  const bool with_faces = looks_at_faces(scene);
  for (const Mesh& mesh : scene.meshes) {
    for (const FloatStream& stream : mesh.position) check_part(stream, 0, stream.size());
    if (!with_faces) continue;
    for (const FloatStream& stream : mesh.normal) check_part(stream, 0, stream.size());
    check_part(mesh.indices, 0, mesh.indices.size());
  }
}

void CheckedClusters::check_texture(const Texture& texture, size_t index) const {
  if (texture_is_checked_[index].load(std::memory_order_acquire)) return;
  for (const TextureLevel& level : texture.levels) check_part(level.bytes, 0, level.bytes.size());
  texture_is_checked_[index].store(true, std::memory_order_release);
}

void CheckedClusters::check_own_streams(const Mesh& mesh, std::span<const uint32_t> vertices) const {
  for (size_t set = 0; set <= mesh.more_uv.size(); ++set)
    for (const FloatStream& stream : mesh.uv_set(set))
      for (const uint32_t vertex : vertices)
        if (!stream.empty()) check_part(stream, vertex, 1);
  for (const FloatStream& stream : mesh.tangent)
    for (const uint32_t vertex : vertices)
      if (!stream.empty()) check_part(stream, vertex, 1);
}

}  // namespace trueshade
