#pragma once
#include <vector>

#include "scenes/files/gltf/document.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

/// The nodes of the scene that is drawn: the document's default scene, else its first, else all root nodes.
struct Hierarchy {
  std::vector<uint32_t> nodes;   ///< of the document, parents before their children, depth first in the file's order
  std::vector<uint32_t> placed;  ///< of each node of the document, its place in `nodes`, or kNone
};

/// Error(limit) for nodes deeper than limits.node_depth.
Hierarchy hierarchy_of(const Document& document, const SceneLimits& limits);

/// Timeline::nodes of a hierarchy, at rest.
std::vector<SceneNode> scene_nodes(const Document& document, const Hierarchy& hierarchy);

}  // namespace trueshade::gltf
