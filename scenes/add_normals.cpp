#include "scenes/add_normals.h"

#include <cassert>
#include <glm/vec3.hpp>
#include <span>

#include "core/fp_env.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

glm::dvec3 position(const Mesh& mesh, uint32_t vertex) {
  return {mesh.position[0][vertex], mesh.position[1][vertex], mesh.position[2][vertex]};
}

/// Twice the triangle's area along its normal.
glm::dvec3 area_normal(const Mesh& mesh, size_t triangle) {
  const glm::dvec3 a = position(mesh, mesh.indices[3 * triangle]);
  return cross(position(mesh, mesh.indices[3 * triangle + 1]) - a, position(mesh, mesh.indices[3 * triangle + 2]) - a);
}

/// unit() without the overflow of squares: lengths of 1e18 give areas of 1e36 and squares of 1e72, well inside double;
/// the small end is what needs care, where squares of areas vanish.
glm::dvec3 unit_of_area(const glm::dvec3& v) {
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) largest = std::fabs(v[k]) > largest ? std::fabs(v[k]) : largest;
  return largest > 0.0 ? unit({v.x / largest, v.y / largest, v.z / largest}) : v;
}

void set_normal(Mesh& mesh, size_t vertex, const glm::dvec3& normal) {
  for (int k = 0; k < 3; ++k) mesh.normal[size_t(k)][vertex] = float(normal[k]);
}

/// The streams with an element for each corner of each triangle.
template <size_t N>
void take_apart(std::array<FloatStream, N>& streams, std::span<const uint32_t> indices) {
  for (FloatStream& stream : streams) {
    if (stream.empty()) continue;
    std::vector<float> corners;
    corners.reserve(indices.size());
    for (const uint32_t index : indices) corners.push_back(stream[index]);
    stream = std::move(corners);
  }
}

}  // namespace

void set_flat_normals(Mesh& mesh) {
  const FpScope fp;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const glm::dvec3 normal = unit_of_area(area_normal(mesh, t));
    for (size_t corner = 3 * t; corner < 3 * t + 3; ++corner) set_normal(mesh, mesh.indices[corner], normal);
  }
}

void add_normals(Mesh& mesh, MissingNormals kind) {
  assert(kind != MissingNormals::creased);
  if (kind == MissingNormals::flat) {
    take_apart(mesh.position, mesh.indices);
    take_apart(mesh.uv, mesh.indices);
    for (UvStreams& set : mesh.more_uv) take_apart(set, mesh.indices);
    take_apart(mesh.color, mesh.indices);
    for (size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = uint32_t(i);
    for (auto& stream : mesh.normal) stream.assign(mesh.indices.size(), 0.0f);
    set_flat_normals(mesh);
    return;
  }
  std::vector<glm::dvec3> sum(mesh.vertex_count(), glm::dvec3(0.0));
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const glm::dvec3 normal = area_normal(mesh, t);
    for (size_t corner = 3 * t; corner < 3 * t + 3; ++corner) sum[mesh.indices[corner]] += normal;
  }
  for (auto& stream : mesh.normal) stream.assign(mesh.vertex_count(), 0.0f);
  for (size_t v = 0; v < sum.size(); ++v) set_normal(mesh, v, unit_of_area(sum[v]));
}

}  // namespace trueshade
