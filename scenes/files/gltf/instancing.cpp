#include "scenes/files/gltf/instancing.h"

#include <algorithm>

#include "scenes/hierarchy.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

uint64_t count_of(const Accessors& accessors, const Copies& copies) {
  uint64_t count = 0;
  for (const uint32_t accessor : {copies.translation, copies.rotation, copies.scale})
    if (accessor != kNone) count = accessors.at(accessor).count;
  return count;
}

std::vector<glm::dmat4x3> matrices_of(Accessors& accessors, const Copies& copies, const std::string& pointer) {
  const uint64_t count = count_of(accessors, copies);  // at most limits.instances
  accessors.take(count * (sizeof(Placement) + sizeof(glm::dmat4x3) + sizeof(Instance) + sizeof(NodeInstance)), pointer);
  std::vector<Placement> places(size_t{count});
  for (int k = 0; k < 4; ++k) {
    const auto read = [&](uint32_t accessor) {
      return accessor == kNone ? std::vector<double>() : accessors.doubles(accessor, uint32_t(k));
    };
    const std::vector<double> translation = k < 3 ? read(copies.translation) : std::vector<double>(),
                              scale = k < 3 ? read(copies.scale) : std::vector<double>(),
                              rotation = read(copies.rotation);
    for (size_t i = 0; i < places.size(); ++i) {
      if (!translation.empty()) places[i].position[k] = translation[i];
      if (!scale.empty()) places[i].scale[k] = scale[i];
      if (!rotation.empty()) places[i].rotation[k] = rotation[i];
    }
  }
  std::vector<glm::dmat4x3> matrices;
  matrices.reserve(places.size());
  for (Placement& place : places) {
    if (!is_nearly_unit(place.rotation))
      accessors.document().fail(pointer_to("accessors", copies.rotation),
                                "the rotation of copy " + std::to_string(matrices.size()) + " is not of unit length",
                                "quaternions of length 1");
    place.rotation = unit(place.rotation);
    matrices.push_back(matrix_of(place));
  }
  return matrices;
}

}  // namespace trueshade::gltf
