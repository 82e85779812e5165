#include "shading/frame_memory.h"

#include <algorithm>
#include <vector>

#include "core/threads/parallel_for.h"
#include "raster/clusters/cluster_draw.h"
#include "raster/clusters/clusters.h"
#include "raster/view.h"
#include "shading/light/light_table.h"
#include "shading/output/derived_planes.h"
#include "shading/output/target.h"
#include "shading/output/view_image.h"

namespace trueshade {
namespace {

static_assert(kDrawnInstanceBytes >= sizeof(Instance) + sizeof(InstanceTransform) + 2 * sizeof(ClusterDraw) +
                                         2 * sizeof(uint32_t) + sizeof(uint64_t));

/// Clusters of a mesh: their triangles and their vertices are limited, and neighbours have vertices in common.
uint64_t clusters_of(const Mesh& mesh) {
  const uint64_t triangles = mesh.triangle_count(), vertices = mesh.vertex_count();
  return std::max((triangles + kClusterTriangles - 1) / kClusterTriangles,
                  (vertices + vertices / 4 + kClusterVertices - 1) / kClusterVertices);
}

uint64_t clustered_bytes(const Mesh& mesh) {
  const uint64_t vertices = std::min<uint64_t>(clusters_of(mesh) * kClusterVertices, 3 * mesh.triangle_count()),
                 of_vertex = 3 * sizeof(float) + sizeof(uint32_t) + (mesh.has_color() ? 7 : 3) * sizeof(float),
                 of_cluster = sizeof(Cluster) + 6 * sizeof(float);
  return vertices * of_vertex + 3 * mesh.triangle_count() + clusters_of(mesh) * of_cluster;
}

uint64_t geometry_bytes(const Scene& scene) {
  uint64_t bytes = 0, largest = 0;
  std::vector<uint64_t> clusters;
  for (const Mesh& mesh : scene.meshes) {
    clusters.push_back(clusters_of(mesh));
    if (!mesh.indices.owned()) continue;  // its clusters lie in the cache file, too
    bytes += clustered_bytes(mesh);
    largest = std::max<uint64_t>(largest, mesh.vertex_count());
  }
  bytes += largest * (sizeof(uint32_t) + sizeof(uint8_t));  // while clusters are made
  for (const Instance& instance : scene.instances)
    bytes += (kDrawnInstanceBytes - sizeof(Instance) - 2 * sizeof(ClusterDraw)) +
             clusters[instance.mesh] * (2 * sizeof(ClusterDraw) + 8);
  return bytes;
}

uint64_t pixel_bytes_of(Format format) { return uint64_t(info(format).bytes_per_texel()); }

/// Bytes a pixel of the target and the planes that a frame has.
uint64_t frame_texel_bytes(const Pipeline& pipeline, std::span<const std::string> aovs) {
  std::vector<std::string> planes(aovs.begin(), aovs.end());
  for (const auto& more : {planes_of_view(pipeline.view), planes_to_draw(planes)})
    for (const std::string& name : more)
      if (std::find(planes.begin(), planes.end(), name) == planes.end()) planes.push_back(name);
  uint64_t bytes = pixel_bytes_of(pipeline.target) + (pipeline.view == ImageView::lit ? 0 : 4);
  for (const std::string& name : planes) bytes += pixel_bytes_of(aov_format(name, surface_planes(pipeline)));
  return bytes;
}

/// Bytes a pixel of the image while the post chain works, besides the frame of planes: the target of samples, float
/// pictures of it and of its averages, what bloom blurs, and the picture that is stored.
uint64_t post_texel_bytes(const Pipeline& pipeline) {
  const PostChain& post = pipeline.post;
  if (pipeline.view != ImageView::lit || !post.active()) return 0;
  constexpr uint64_t kPicture = 4 * sizeof(float);
  const uint64_t samples = uint64_t(post.samples) * uint64_t(post.samples), markers = post.marker_radius > 0.0f ? 1 : 0,
                 target = samples > 1 ? samples * (pixel_bytes_of(pipeline.target) + 4 * markers) : 0,
                 averaged = samples > 1 ? kPicture : 0, drawn = samples * (kPicture + 4 * markers) + averaged,
                 bloom = post.bloom.strength > 0.0f ? 3 * kPicture : 0, edges = post.edge_filter ? 2 * kPicture : 0,
                 stored = kPicture + pixel_bytes_of(post.output);
  return target + std::max({drawn, bloom, edges, stored});
}

}  // namespace

uint64_t predicted_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                          std::span<const std::string> aovs) {
  constexpr uint64_t kOfThread = uint64_t(3) << 20, kOfLight = sizeof(LightRow) + sizeof(Light) + 32;
  const uint64_t pixels = drawn_pixels(pipeline, execution.region);
  return geometry_bytes(scene) + scene.lights.size() * kOfLight +
         uint64_t(thread_count(execution.threads)) * kOfThread +
         pixels * (frame_texel_bytes(pipeline, aovs) + post_texel_bytes(pipeline));
}

}  // namespace trueshade
