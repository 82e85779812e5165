#include "gl/driver/volume_batches.h"

#include <cstddef>

namespace trueshade::oracle {

namespace {

struct Vertex {
  glm::vec3 corner;
  int32_t light;
};

constexpr glm::vec3 kQuad[] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
constexpr uint32_t kQuadIndices[] = {0, 1, 2, 2, 1, 3};

}  // namespace

VolumeBatches make_volume_batches(std::span<const Light> lights, const LightVolumes& volumes) {
  const LightMeshes meshes(volumes);
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<glm::vec3> corners;
  VolumeBatches out;
  for (size_t i = 0; i < lights.size(); ++i) {
    const LightExtent extent = drawn_extent(lights[i], volumes);
    const bool mesh = is_mesh(extent);
    std::span<const uint32_t> faces = kQuadIndices;
    corners.assign(std::begin(kQuad), std::end(kQuad));
    if (mesh) {
      const LightMesh& shape = meshes[extent];
      faces = shape.indices;
      corners.resize(shape.unit.size());
      light_vertices(shape, lights[i], corners);
    }
    if (out.runs.empty() || out.runs.back().mesh != mesh) out.runs.push_back({mesh, 0, indices.size()});
    out.runs.back().count += GLsizei(faces.size());
    for (const uint32_t face : faces) indices.push_back(uint32_t(vertices.size()) + face);
    for (const glm::vec3& corner : corners) vertices.push_back({corner, int32_t(i)});
  }
  out.array = make_vertex_array();
  glBindVertexArray(out.array);
  out.vertices = make_buffer(GL_ARRAY_BUFFER, std::span<const Vertex>(vertices));
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribIPointer(1, 1, GL_INT, sizeof(Vertex), reinterpret_cast<const void*>(offsetof(Vertex, light)));
  out.indices = make_buffer(GL_ELEMENT_ARRAY_BUFFER, std::span<const uint32_t>(indices));
  return out;
}

}  // namespace trueshade::oracle
