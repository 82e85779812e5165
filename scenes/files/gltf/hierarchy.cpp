#include "scenes/files/gltf/hierarchy.h"

#include <algorithm>
#include <iterator>

#include "core/error.h"
#include "scenes/hierarchy.h"

namespace trueshade::gltf {

namespace {

/// Those that lie below none of the others. Nodes of a scene are roots, unless a fault was passed over.
std::vector<uint32_t> outermost(const Document& document, const std::vector<uint32_t>& nodes) {
  std::vector<bool> is_below(document.nodes.size(), false);
  std::vector<uint32_t> waiting = nodes, out;
  while (!waiting.empty()) {
    const uint32_t node = waiting.back();
    waiting.pop_back();
    for (const uint32_t child : document.nodes[node].children) {
      if (is_below[child]) continue;
      is_below[child] = true;
      waiting.push_back(child);
    }
  }
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(out), [&](uint32_t node) { return !is_below[node]; });
  return out;
}

}  // namespace

Hierarchy hierarchy_of(const Document& document, const SceneLimits& limits) {
  struct Waiting {
    uint32_t node;
    uint64_t depth;
  };
  std::vector<uint32_t> roots;
  if (!document.scenes.empty()) {
    roots = outermost(document, document.scenes[document.scene == kNone ? 0 : document.scene]);
  } else {
    for (uint32_t i = 0; i < document.nodes.size(); ++i)
      if (document.nodes[i].parent == kNone) roots.push_back(i);
  }
  Hierarchy out;
  out.placed.assign(document.nodes.size(), kNone);
  std::vector<Waiting> waiting;  // the next one last
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) waiting.push_back({*root, 1});
  while (!waiting.empty()) {
    const Waiting at = waiting.back();
    waiting.pop_back();
    if (at.depth > limits.node_depth)
      throw Error(ErrorKind::limit, document.file + ": " + pointer_to("nodes", at.node),
                  "the node lies deeper than the limit", within_limit(limits.node_depth, "levels", "--max-node-depth"));
    out.placed[at.node] = uint32_t(out.nodes.size());
    out.nodes.push_back(at.node);
    const std::vector<uint32_t>& children = document.nodes[at.node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) waiting.push_back({*child, at.depth + 1});
  }
  return out;
}

std::vector<SceneNode> scene_nodes(const Document& document, const Hierarchy& hierarchy) {
  std::vector<SceneNode> out;
  out.reserve(hierarchy.nodes.size());
  for (const uint32_t index : hierarchy.nodes) {
    const NodeSource& node = document.nodes[index];
    const uint32_t parent = node.parent == kNone ? kNone : hierarchy.placed[node.parent];
    out.push_back({parent == kNone ? -1 : int32_t(parent), node.matrix ? *node.matrix : matrix_of(node.placement)});
  }
  return out;
}

}  // namespace trueshade::gltf
