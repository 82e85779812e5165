#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {

/// A triangle of an instance, in world space.
struct Face {
  std::array<glm::dvec3, 3> at;
  glm::dvec3 front;   ///< to the side from which its corners run counter-clockwise, as long as twice its area
  bool agrees;        ///< the normals of its corners are on that side
  uint32_t material;  ///< into Scene::materials
};

/// Calls use(face) for each triangle of some instances of a scene.
template <class Use>
void for_each_face(const Scene& scene, std::span<const Instance> instances, const Use& use) {
  const auto vector = [](const std::array<FloatStream, 3>& values, size_t i) {
    return glm::dvec3(values[0][i], values[1][i], values[2][i]);
  };
  for (const Instance& instance : instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto& from = instance.world_from_object;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      std::array<glm::dvec3, 3> object;
      glm::dvec3 normals(0.0);
      Face face;
      for (size_t k = 0; k < 3; ++k) {
        object[k] = vector(mesh.position, mesh.indices[i + k]);
        if (!mesh.normal[0].empty()) normals += vector(mesh.normal, mesh.indices[i + k]);
        face.at[k] = glm::dvec3(from[3]);
        for (int axis = 0; axis < 3; ++axis) face.at[k] += glm::dvec3(from[axis]) * object[k][axis];
      }
      face.front = cross(face.at[1] - face.at[0], face.at[2] - face.at[0]) * (instance.mirrored ? -1.0 : 1.0);
      face.agrees = !(dot(cross(object[1] - object[0], object[2] - object[0]), normals) < 0.0);
      face.material = instance.material;
      use(face);
    }
  }
}

}  // namespace trueshade
