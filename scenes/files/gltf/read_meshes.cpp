#include <algorithm>

#include "scenes/files/gltf/reading.h"

// Meshes: which accessors are whose attributes, and whether their types may be.
namespace trueshade::gltf {
namespace {

using enum Component;

/// What an attribute's accessor may be: bits of components, those that must be normalized, those that quantization
/// (KHR_mesh_quantization) adds as they are or normalized.
struct Allowed {
  std::string_view name;
  uint32_t shapes, plain, normalized, quantized_plain, quantized_normalized;
};

constexpr uint32_t bit(Component c) { return 1u << uint32_t(c); }
constexpr uint32_t bit(Shape s) { return 1u << uint32_t(s); }
constexpr uint32_t kSmall = bit(int8) | bit(uint8) | bit(int16) | bit(uint16), kFloat = bit(float32);
constexpr uint32_t kUnsigned = bit(uint8) | bit(uint16), kSigned = bit(int8) | bit(int16);
constexpr uint32_t kVec3 = bit(Shape::vec3), kVec4 = bit(Shape::vec4), kVec2 = bit(Shape::vec2);

constexpr Allowed kAttributes[] = {
    {"POSITION", kVec3, kFloat, 0, kSmall, kSmall},     {"NORMAL", kVec3, kFloat, 0, 0, kSigned},
    {"TANGENT", kVec4, kFloat, 0, 0, kSigned},          {"TEXCOORD_", kVec2, kFloat, kUnsigned, kSmall, kSigned},
    {"COLOR_", kVec3 | kVec4, kFloat, kUnsigned, 0, 0}, {"JOINTS_", kVec4, kUnsigned, 0, 0, 0},
    {"WEIGHTS_", kVec4, kFloat, kUnsigned, 0, 0}};
constexpr Allowed kTargets[] = {{"POSITION", kVec3, kFloat, 0, kSigned, kSigned},
                                {"NORMAL", kVec3, kFloat, 0, 0, kSigned},
                                {"TANGENT", kVec3, kFloat, 0, 0, kSigned},
                                {"TEXCOORD_", kVec2, kFloat, kSigned | kUnsigned, kSmall, kSmall},
                                {"COLOR_", kVec3 | kVec4, kFloat, kSigned | kUnsigned, 0, 0}};

/// The row of an attribute's name, and the number behind a name that ends in '_'.
const Allowed* row_of(std::string_view name, std::span<const Allowed> rows, uint32_t& set) {
  for (const Allowed& row : rows) {
    if (!row.name.ends_with('_') && name == row.name) return &row;
    if (!row.name.ends_with('_') || !name.starts_with(row.name)) continue;
    const std::string_view number = name.substr(row.name.size());
    if (number.empty() || number.size() > 3 || (number.size() > 1 && number[0] == '0')) return nullptr;
    set = 0;
    for (const char digit : number) {
      if (digit < '0' || digit > '9') return nullptr;
      set = 10 * set + uint32_t(digit - '0');
    }
    return &row;
  }
  return nullptr;
}

bool is_allowed(const Accessor& a, const Allowed& row, bool quantization) {
  const uint32_t plain = row.plain | (quantization ? row.quantized_plain : 0),
                 normalized = row.normalized | (quantization ? row.quantized_normalized : 0);
  return (row.shapes & bit(a.shape)) != 0 && ((a.normalized ? normalized : plain) & bit(a.type)) != 0;
}

/// Puts an accessor where it is read; sets of joints and weights must follow each other from 0 on.
void assign(const json::Node& node, const Allowed& row, uint32_t set, uint32_t accessor, Attributes& out) {
  const auto append = [&](std::vector<uint32_t>& sets) {
    if (sets.size() <= set) sets.resize(set + 1, kNone);
    sets[set] = accessor;
  };
  if (row.name == "POSITION") out.position = accessor;
  if (row.name == "NORMAL") out.normal = accessor;
  if (row.name == "TANGENT") out.tangent = accessor;
  if (row.name == "COLOR_" && set == 0) out.color = accessor;
  if (set >= 16) node.fail("the number of an attribute is over 15", "a smaller one");
  if (row.name == "TEXCOORD_") append(out.uv);
  if (row.name == "JOINTS_") append(out.joints);
  if (row.name == "WEIGHTS_") append(out.weights);
}

Attributes read_attributes(const json::Node& node, std::span<const Allowed> rows, const Counts& counts,
                           Document& document, std::optional<uint64_t>& vertices) {
  Attributes out;
  node.find("");  // fails unless it is an object
  const json::Members& members = *std::get<std::unique_ptr<json::Members>>(node.value().is);
  for (const auto& [name, value] : members) {
    const json::Node member(value, node, std::string_view(name));
    const uint32_t accessor = index(member, counts.accessors, "accessor");
    const Accessor& a = document.accessors[accessor];
    if (vertices && a.count != *vertices)
      member.fail(
          "the accessor has " + std::to_string(a.count) + " elements and others have " + std::to_string(*vertices),
          "one element a vertex");
    vertices = a.count;
    if (name.starts_with('_')) continue;  // an application's own
    uint32_t set = 0;
    const Allowed* row = row_of(name, rows, set);
    if (!row) {
      document.pass(Fault::value, member.pointer(), "this attribute is not in glTF",
                    "a name of glTF, or one that starts with '_'");
      continue;
    }
    if (!is_allowed(a, *row, document.quantized))
      member.fail("the accessor's type does not go with the attribute", "a type of glTF 2.0, 3.7.2.1");
    if (a.count >= kNone) member.fail(std::to_string(a.count) + " vertices", "below 2^32 - 1");
    assign(member, *row, set, accessor, out);
  }
  if (members.empty()) node.fail("there is no attribute", "POSITION");
  const auto missing = [](const std::vector<uint32_t>& sets) {
    return std::find(sets.begin(), sets.end(), kNone) != sets.end();
  };
  if (out.joints.size() != out.weights.size() || missing(out.joints) || missing(out.weights))
    node.fail("there are not as many JOINTS as WEIGHTS", "both, numbered from 0 on");
  return out;
}

void check_indices(const json::Node& node, const Accessor& a, Document& document) {
  if (a.shape != Shape::scalar || (a.type != uint8 && a.type != uint16 && a.type != uint32) || a.normalized)
    node.fail("the accessor's type does not go with indices", "SCALAR of 5121, 5123 or 5125");
  if (a.view != kNone && document.views[a.view].stride != 0)
    document.pass(Fault::stride, node.pointer(), "the view of indices has a stride", "a view without one");
}

/// A target's attributes are among the primitive's.
void check_target(const json::Node& node, const Attributes& target, const Attributes& base) {
  const bool lacks = (target.position != kNone && base.position == kNone) ||
                     (target.normal != kNone && base.normal == kNone) || (target.color != kNone && base.color == kNone);
  bool lacks_uv = false;
  for (size_t set = 0; set < target.uv.size(); ++set)
    lacks_uv = lacks_uv || (target.uv[set] != kNone && base.uv_set(set) == kNone);
  if (lacks || lacks_uv)
    node.fail("a target moves an attribute that the primitive does not have", "attributes of the primitive");
}

Primitive read_primitive(const json::Node& node, const Counts& counts, Document& document) {
  Primitive out;
  std::optional<uint64_t> vertices;
  const json::Node attributes = node.member("attributes");
  out.attributes = read_attributes(attributes, kAttributes, counts, document, vertices);
  out.mode = Mode(whole_or(node, "mode", uint64_t(Mode::triangles), 0, 6));
  out.material = index_or_none(node, "material", counts.materials, "material");
  if (const auto indices = node.find("indices")) {
    out.indices = index(*indices, counts.accessors, "accessor");
    check_indices(*indices, document.accessors[out.indices], document);
  }
  for_each(node, "targets", [&](const json::Node& target, size_t) {
    out.targets.push_back(read_attributes(target, kTargets, counts, document, vertices));
    check_target(target, out.targets.back(), out.attributes);
  });
  extensions_of(node);
  return out;
}

/// Each texture of a primitive's material finds its texture coordinates.
void check_uv_sets(const json::Node& node, const Primitive& primitive, Document& document) {
  if (primitive.material == kNone) return;
  const MaterialSource& m = document.materials[primitive.material];
  for (const TextureInfo* map :
       {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.occlusion_map, &m.emission_map}) {
    if (map->texture == kNone || primitive.attributes.uv_set(map->uv.set) != kNone) continue;
    document.pass(Fault::coordinates, node.pointer(),
                  "the material reads TEXCOORD_" + std::to_string(map->uv.set) + ", which is not there",
                  "texture coordinates for the material's textures");
  }
}

}  // namespace

std::vector<double> read_weights(const json::Node& object) {
  std::vector<double> weights;
  for_each(object, "weights", [&](const json::Node& weight, size_t) {
    weights.push_back(weight.number(-json::kLargest, json::kLargest));
  });
  return weights;
}

void read_meshes(const json::Node& root, const Counts& counts, Document& document) {
  for_each(root, "meshes", [&](const json::Node& node, size_t) {
    MeshSource mesh;
    mesh.name = string_or_empty(node, "name");
    node.member("primitives");
    for_each(node, "primitives", [&](const json::Node& element, size_t) {
      mesh.primitives.push_back(read_primitive(element, counts, document));
      mesh.has_joints = mesh.has_joints || !mesh.primitives.back().attributes.joints.empty();
      check_uv_sets(element, mesh.primitives.back(), document);
      if (mesh.primitives.back().targets.size() != mesh.primitives.front().targets.size())
        element.fail("the primitives of a mesh differ in their number of targets", "as many as the first has");
    });
    mesh.weights = read_weights(node);
    if (!mesh.weights.empty() && mesh.weights.size() != mesh.primitives.front().targets.size())
      node.member("weights").fail("there are " + std::to_string(mesh.weights.size()) + " weights for " +
                                      std::to_string(mesh.primitives.front().targets.size()) + " targets",
                                  "one a target");
    document.meshes.push_back(std::move(mesh));
  });
}

}  // namespace trueshade::gltf
