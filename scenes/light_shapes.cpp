#include "scenes/light_shapes.h"

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"

namespace trueshade {
namespace {

/// `side` times the mesh, moved to `place`.
glm::mat4x3 moved(const glm::vec3& place, float side) {
  glm::mat4x3 m(0.0f);
  for (int axis = 0; axis < 3; ++axis) m[axis][axis] = side;
  m[3] = place;
  return m;
}

/// A scene seen as `scene` is, of nothing yet.
Scene seen_alike(const Scene& scene) {
  Scene out;
  out.spec = scene.spec;
  out.camera = scene.camera;
  return out;
}

template <typename Use>
void for_each_box(const Scene& scene, const Use& use) {
  for (const Light& light : scene.lights)
    if (is_placed(light.type) && std::isfinite(2.0f * light.range)) use(light, moved(light.position, 2.0f * light.range));
}

glm::vec3 full_color(const glm::vec3& color) {
  const float most = std::max(std::max(color.r, color.g), color.b);
  return most > 0.0f ? color / most : glm::vec3(0.0f);
}

/// The twelve edges of [-1/2, 1/2]^3 as boxes of `thickness`, whose faces share corners: their normals are not used.
Mesh frame_mesh(double thickness) {
  const Mesh cube = cube_mesh();
  Mesh frame;
  frame.name = "box edges";
  for (int bar = 0; bar < 12; ++bar) {
    const int along = bar / 4, first = (along + 1) % 3, second = (along + 2) % 3;
    glm::dvec3 center(0.0), size(thickness);
    size[along] = 1.0;
    center[first] = (bar % 2 == 0 ? -0.5 : 0.5) * (1.0 - thickness);
    center[second] = (bar / 2 % 2 == 0 ? -0.5 : 0.5) * (1.0 - thickness);
    const auto base = uint32_t(frame.vertex_count());
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 corner(k % 2 - 0.5, k / 2 % 2 - 0.5, k / 4 - 0.5);
      add_vertex(frame, center + size * corner, corner / std::sqrt(0.75));
    }
    for (const uint32_t index : cube.indices)
      frame.indices.push_back(base + (cube.position[0][index] > 0.0f ? 1u : 0u) +
                              (cube.position[1][index] > 0.0f ? 2u : 0u) + (cube.position[2][index] > 0.0f ? 4u : 0u));
  }
  return frame;
}

}  // namespace

Scene light_boxes(const Scene& scene) {
  Scene boxes = seen_alike(scene);
  boxes.meshes = {cube_mesh()};
  boxes.materials = {{"light volume", {0.0f, 0.0f, 0.0f, 1.0f}}};
  for_each_box(scene, [&](const Light&, const glm::mat4x3& place) { boxes.instances.push_back({0, 0, place}); });
  return boxes;
}

Scene light_box_edges(const Scene& scene) {
  Scene edges = seen_alike(scene);
  edges.meshes = {frame_mesh(1.0 / 256.0)};
  for_each_box(scene, [&](const Light& light, const glm::mat4x3& place) {
    edges.instances.push_back({0, uint32_t(edges.materials.size()), place});
    edges.materials.push_back({"light", glm::vec4(full_color(light.color), 1.0f)});
  });
  return edges;
}

Scene light_markers(const Scene& scene, float radius) {
  Scene markers = seen_alike(scene);
  markers.meshes = {sphere_mesh(8)};
  for (const Light& light : scene.lights) {
    if (!is_placed(light.type)) continue;
    markers.instances.push_back({0, uint32_t(markers.materials.size()), moved(light.position, radius)});
    markers.materials.push_back({"light", glm::vec4(full_color(light.color), 1.0f)});
  }
  return markers;
}

}  // namespace trueshade
