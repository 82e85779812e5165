#include "scenes/files/gltf/gltf_geometry.h"

#include <map>

#include "core/fp_env.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

/// Appends a stream, or `count` times `absent` where it is empty and others are not.
template <size_t N>
void append_streams(const std::array<FloatStream, N>& from, size_t count, float absent, size_t before,
                    std::array<FloatStream, N>& to) {
  if (from[0].empty() && to[0].empty()) return;
  for (size_t k = 0; k < N; ++k) {
    to[k].resize(before, absent);
    if (from[k].empty())
      to[k].resize(before + count, absent);
    else
      to[k].insert(to[k].end(), from[k].begin(), from[k].end());
  }
}

void move_vertices(Mesh& mesh, size_t first, const glm::mat4x3& world_from_object) {
  const glm::dmat4x3 m(world_from_object);
  const glm::dvec3 x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
  const double sign = dot(m[0], x) < 0.0 ? -1.0 : 1.0;
  for (size_t v = first; v < mesh.vertex_count(); ++v) {
    glm::dvec3 p, n;
    for (int k = 0; k < 3; ++k) p[k] = double(mesh.position[size_t(k)][v]), n[k] = double(mesh.normal[size_t(k)][v]);
    glm::dvec3 turned;
    for (int r = 0; r < 3; ++r) {
      mesh.position[size_t(r)][v] = float(((m[0][r] * p.x + m[1][r] * p.y) + m[2][r] * p.z) + m[3][r]);
      turned[r] = sign * ((x[r] * n.x + y[r] * n.y) + z[r] * n.z);
    }
    turned = unit(turned);
    for (int r = 0; r < 3; ++r) mesh.normal[size_t(r)][v] = float(turned[r]);
  }
}

void append_instance(const Mesh& mesh, const glm::mat4x3& world_from_object, Mesh& to) {
  const size_t before = to.vertex_count(), count = mesh.vertex_count(), first_index = to.indices.size();
  append_streams(mesh.uv, count, 0.0f, before, to.uv);
  to.more_uv.resize(std::max(mesh.more_uv.size(), to.more_uv.size()));
  for (size_t k = 0; k < to.more_uv.size(); ++k) append_streams(mesh.uv_set(k + 1), count, 0.0f, before, to.more_uv[k]);
  append_streams(mesh.color, count, 1.0f, before, to.color);
  append_streams(mesh.normal, count, 0.0f, before, to.normal);
  append_streams(mesh.position, count, 0.0f, before, to.position);
  for (const uint32_t index : mesh.indices) to.indices.push_back(uint32_t(before) + index);
  if (world_from_object == glm::mat4x3(1.0f)) return;
  move_vertices(to, before, world_from_object);
  if (!mirrors(world_from_object)) return;
  for (size_t i = first_index; i < to.indices.size(); i += 3) std::swap(to.indices[i + 1], to.indices[i + 2]);
}

}  // namespace

GltfGeometry geometry_of(Scene&& scene) {
  const FpScope fp;
  GltfGeometry out;
  std::map<uint32_t, size_t> parts;  // by material
  for (const Instance& instance : scene.instances) {
    const auto [found, is_new] = parts.emplace(instance.material, out.parts.size());
    if (is_new) out.parts.push_back({Mesh(), instance.material});
    append_instance(scene.meshes[instance.mesh], instance.world_from_object, out.parts[found->second].mesh);
  }
  out.materials = std::move(scene.materials);
  out.textures = std::move(scene.textures);
  return out;
}

}  // namespace trueshade
