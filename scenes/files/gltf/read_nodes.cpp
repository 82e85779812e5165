#include <cmath>

#include "scenes/files/gltf/reading.h"

// Nodes, skins and scenes.
namespace trueshade::gltf {
namespace {

constexpr double kUnitError = 0.00769;  ///< of a quaternion's length: what normalized bytes may miss

glm::dvec3 read_three(const json::Node& node) {
  node.array(3, 3);
  glm::dvec3 out;
  for (int k = 0; k < 3; ++k) out[k] = node.element(size_t(k)).number(-kLargest, kLargest);
  return out;
}

glm::dvec4 read_rotation(const json::Node& node) {
  node.array(4, 4);
  glm::dvec4 q;
  for (int k = 0; k < 4; ++k) q[k] = node.element(size_t(k)).number(-2.0, 2.0);
  if (!is_nearly_unit(q)) node.fail("the quaternion is not of unit length", "x, y, z, w of length 1");
  return unit(q);
}

glm::dmat4x3 read_matrix(const json::Node& node) {
  constexpr double kRowError = 1e-6;
  node.array(16, 16);
  glm::dmat4x3 out(0.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row)
      out[column][row] = node.element(size_t(4 * column + row)).number(-kLargest, kLargest);
    const double last = node.element(size_t(4 * column + 3)).number(-kLargest, kLargest);
    if (!(std::fabs(last - (column == 3 ? 1.0 : 0.0)) <= kRowError))
      node.fail("the matrix does more than move, turn, scale and shear", "a last row of 0, 0, 0, 1");
  }
  return out;
}

void read_transform(const json::Node& node, NodeSource& out) {
  const auto matrix = node.find("matrix"), translation = node.find("translation"), rotation = node.find("rotation"),
             scale = node.find("scale");
  if (matrix && (translation || rotation || scale))
    node.fail("a node has a matrix and one of translation, rotation, scale", "one or the other");
  if (matrix) out.matrix = read_matrix(*matrix);
  if (translation) out.placement.position = read_three(*translation);
  if (rotation) out.placement.rotation = read_rotation(*rotation);
  if (scale) out.placement.scale = read_three(*scale);
}

Copies read_copies(const json::Node& node, const Counts& counts, const Document& document) {
  Copies copies;
  const json::Node attributes = node.member("attributes");
  std::optional<uint64_t> count;
  const auto accessor = [&](std::string_view key, Shape shape, bool normalized_integers) {
    const auto found = attributes.find(key);
    if (!found) return kNone;
    const uint32_t i = index(*found, counts.accessors, "accessor");
    const Accessor& a = document.accessors[i];
    const bool small = a.normalized && (a.type == Component::int8 || a.type == Component::int16);
    if (a.shape != shape || (a.type != Component::float32 && !(normalized_integers && small)))
      found->fail("the accessor's type does not go with the attribute", "a type of EXT_mesh_gpu_instancing");
    if (count && *count != a.count) found->fail("the attributes differ in their number of elements", "one a copy");
    count = a.count;
    return i;
  };
  copies.translation = accessor("TRANSLATION", Shape::vec3, false);
  copies.rotation = accessor("ROTATION", Shape::vec4, true);
  copies.scale = accessor("SCALE", Shape::vec3, false);
  if (!count) attributes.fail("there is no TRANSLATION, ROTATION or SCALE", "one of them at least");
  return copies;
}

void read_node_extensions(const json::Node& node, const Counts& counts, const Document& document, NodeSource& out) {
  const auto extensions = extensions_of(node);
  if (!extensions) return;
  if (const auto light = extensions->find("KHR_lights_punctual"))
    out.light = index(light->member("light"), counts.lights, "light");
  if (const auto instancing = extensions->find("EXT_mesh_gpu_instancing"))
    out.copies = read_copies(*instancing, counts, document);
}

void check_mesh_values(const json::Node& node, const Document& document, const NodeSource& out) {
  if (out.mesh == kNone) {
    if (out.skin != kNone) node.member("skin").fail("the node has a skin and no mesh", "a mesh, or no skin");
    if (!out.weights.empty()) node.member("weights").fail("the node has weights and no mesh", "a mesh, or no weights");
    return;
  }
  const MeshSource& mesh = document.meshes[out.mesh];
  const size_t targets = mesh.primitives.front().targets.size();
  if (!out.weights.empty() && out.weights.size() != targets)
    node.member("weights").fail(
        "there are " + std::to_string(out.weights.size()) + " weights for " + std::to_string(targets) + " targets",
        "one a target");
  if (out.skin != kNone && !mesh.has_joints)
    node.member("skin").fail("the node has a skin and its mesh has no joints", "JOINTS_0 and WEIGHTS_0, or no skin");
}

NodeSource read_node(const json::Node& node, const Counts& counts, const Document& document) {
  NodeSource out;
  out.name = string_or_empty(node, "name");
  for_each(node, "children",
           [&](const json::Node& child, size_t) { out.children.push_back(index(child, counts.nodes, "node")); });
  out.mesh = index_or_none(node, "mesh", counts.meshes, "mesh");
  out.skin = index_or_none(node, "skin", counts.skins, "skin");
  out.camera = index_or_none(node, "camera", counts.cameras, "camera");
  read_transform(node, out);
  out.weights = read_weights(node);
  read_node_extensions(node, counts, document, out);
  check_mesh_values(node, document, out);
  return out;
}

/// Gives each node its parent. One at most, and no node is below itself: the way up from every node ends.
void connect(Document& document) {
  std::vector<NodeSource>& nodes = document.nodes;
  for (uint32_t i = 0; i < nodes.size(); ++i)
    for (size_t k = 0; k < nodes[i].children.size(); ++k) {
      NodeSource& child = nodes[nodes[i].children[k]];
      if (child.parent != kNone)
        document.fail(pointer_to("nodes", i, "children", k),
                      "node " + std::to_string(nodes[i].children[k]) + " has two parents, " +
                          std::to_string(child.parent) + " and " + std::to_string(i),
                      "one parent a node");
      child.parent = i;
    }
  std::vector<uint32_t> way(nodes.size(), kNone);  // from which node it was walked
  for (uint32_t i = 0; i < nodes.size(); ++i)
    for (uint32_t at = i; at != kNone && way[at] != i; at = nodes[at].parent) {
      if (way[at] != kNone) break;
      way[at] = i;
      if (nodes[at].parent != kNone && way[nodes[at].parent] == i)
        document.fail(pointer_to("nodes", at), "the node is below itself", "a hierarchy without loops");
    }
}

/// Where nodes come in a walk from the roots, children behind their parent, and how many lie below each, itself
/// counted.
struct Walk {
  std::vector<uint32_t> root, place, below;
  bool is_above(uint32_t above, uint32_t node) const {
    return place[node] >= place[above] && place[node] - place[above] < below[above];
  }
};

Walk walk_of(const Document& document) {
  const std::vector<NodeSource>& nodes = document.nodes;
  Walk walk{std::vector<uint32_t>(nodes.size()), std::vector<uint32_t>(nodes.size()),
            std::vector<uint32_t>(nodes.size(), 1)};
  std::vector<uint32_t> order, waiting;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent != kNone) continue;
    waiting.push_back(i);
    while (!waiting.empty()) {
      const uint32_t at = waiting.back();
      waiting.pop_back();
      walk.root[at] = i;
      walk.place[at] = uint32_t(order.size());
      order.push_back(at);
      waiting.insert(waiting.end(), nodes[at].children.begin(), nodes[at].children.end());
    }
  }
  for (auto at = order.rbegin(); at != order.rend(); ++at)
    if (nodes[*at].parent != kNone) walk.below[nodes[*at].parent] += walk.below[*at];
  return walk;
}

SkinSource read_skin(const json::Node& node, const Counts& counts, const Document& document) {
  SkinSource skin;
  node.member("joints");
  for_each(node, "joints",
           [&](const json::Node& joint, size_t) { skin.joints.push_back(index(joint, counts.nodes, "node")); });
  skin.skeleton = index_or_none(node, "skeleton", counts.nodes, "node");
  const auto matrices = node.find("inverseBindMatrices");
  if (!matrices) return skin;
  skin.inverse_bind = index(*matrices, counts.accessors, "accessor");
  const Accessor& a = document.accessors[skin.inverse_bind];
  if (a.shape != Shape::mat4 || a.type != Component::float32)
    matrices->fail("the accessor is not of matrices", "MAT4 of component type 5126");
  if (a.count < skin.joints.size())
    matrices->fail(
        "there are " + std::to_string(a.count) + " matrices for " + std::to_string(skin.joints.size()) + " joints",
        "one a joint");
  return skin;
}

/// Joints share a root, so that one scene holds them all; the skeleton is above all of them.
void check_skins(const Document& document) {
  if (document.skins.empty()) return;
  const Walk walk = walk_of(document);
  std::vector<size_t> named(document.nodes.size(), SIZE_MAX);  // by which skin
  for (size_t s = 0; s < document.skins.size(); ++s) {
    const SkinSource& skin = document.skins[s];
    for (size_t j = 0; j < skin.joints.size(); ++j) {
      if (named[skin.joints[j]] == s)
        document.fail(pointer_to("skins", s, "joints", j), "node " + std::to_string(skin.joints[j]) + " is named twice",
                      "each joint once");
      named[skin.joints[j]] = s;
      if (walk.root[skin.joints[j]] != walk.root[skin.joints.front()])
        document.fail(pointer_to("skins", s, "joints", j), "the joints have no common root", "joints of one hierarchy");
      if (skin.skeleton != kNone && !walk.is_above(skin.skeleton, skin.joints[j]))
        document.fail(pointer_to("skins", s, "skeleton"), "the skeleton is not above all joints", "a common root");
    }
  }
}

void read_scenes(const json::Node& root, const Counts& counts, Document& document) {
  std::vector<size_t> named(counts.nodes, SIZE_MAX);  // by which scene
  for_each(root, "scenes", [&](const json::Node& node, size_t scene) {
    std::vector<uint32_t>& roots = document.scenes.emplace_back();
    for_each(node, "nodes", [&](const json::Node& element, size_t) {
      const uint32_t root = index(element, counts.nodes, "node");
      if (document.nodes[root].parent != kNone)
        document.pass(Fault::root, element.pointer(), "node " + std::to_string(root) + " is no root: it has a parent",
                      "root nodes");
      if (named[root] == scene) {
        document.pass(Fault::root, element.pointer(), "node " + std::to_string(root) + " is named twice",
                      "each root once");
        return;
      }
      named[root] = scene;
      roots.push_back(root);
    });
  });
  if (const auto scene = root.find("scene"); scene && counts.scenes == 0)
    document.pass(Fault::value, scene->pointer(), "there are no scenes", "a list of scenes with one");
  else
    document.scene = index_or_none(root, "scene", counts.scenes, "scene");
}

}  // namespace

bool is_nearly_unit(const glm::dvec4& q) {
  const double length = std::sqrt(((q.x * q.x + q.y * q.y) + q.z * q.z) + q.w * q.w);
  return std::fabs(length - 1.0) <= kUnitError;
}

void read_nodes(const json::Node& root, const Counts& counts, Document& document) {
  document.nodes.reserve(counts.nodes);
  for_each(root, "nodes",
           [&](const json::Node& node, size_t) { document.nodes.push_back(read_node(node, counts, document)); });
  connect(document);
  for_each(root, "skins",
           [&](const json::Node& node, size_t) { document.skins.push_back(read_skin(node, counts, document)); });
  check_skins(document);
  read_scenes(root, counts, document);
}

}  // namespace trueshade::gltf
