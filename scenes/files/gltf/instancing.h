#pragma once
#include <glm/mat4x3.hpp>
#include <string>
#include <vector>

#include "scenes/files/gltf/accessors.h"

namespace trueshade::gltf {

/// EXT_mesh_gpu_instancing: how many copies a node has, and where each of them stands on the node. Error(limit) behind
/// `pointer` for copies that do not fit into the geometry's memory.
uint64_t count_of(const Accessors& accessors, const Copies& copies);
std::vector<glm::dmat4x3> matrices_of(Accessors& accessors, const Copies& copies, const std::string& pointer);

}  // namespace trueshade::gltf
