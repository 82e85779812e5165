#include "scenes/files/gltf/meshes.h"

#include <algorithm>

#include "scenes/add_normals.h"
#include "scenes/files/gltf/mikk_tangents.h"

namespace trueshade::gltf {
namespace {

template <size_t N>
void read_streams(Accessors& accessors, uint32_t accessor, std::array<FloatStream, N>& streams) {
  if (accessor == kNone) return;
  const uint32_t components = components_of(accessors.at(accessor).shape);
  for (uint32_t k = 0; k < N && k < components; ++k) streams[k] = accessors.floats(accessor, k);
}

/// Corners as the primitive lists them.
std::vector<uint32_t> read_corners(Accessors& accessors, const Primitive& primitive, size_t vertices,
                                   const std::string& pointer) {
  if (primitive.indices == kNone) {
    accessors.take(vertices * sizeof(uint32_t), pointer);
    std::vector<uint32_t> corners(vertices);
    for (size_t i = 0; i < vertices; ++i) corners[i] = uint32_t(i);
    return corners;
  }
  std::vector<uint32_t> corners = accessors.integers(primitive.indices, 0);
  const uint32_t restart = UINT32_MAX >> (32 - 8 * bytes_of(accessors.at(primitive.indices).type));
  if (const auto found = std::find(corners.begin(), corners.end(), restart); found != corners.end())
    accessors.document().fail(pointer + "/indices",
                              "index " + std::to_string(restart) + " at " + std::to_string(found - corners.begin()) +
                                  " is the largest of its type, a primitive restart",
                              "indices below it; there is no primitive restart in glTF");
  for (size_t i = 0; i < corners.size(); ++i)
    if (corners[i] >= vertices)
      accessors.document().fail(
          pointer + "/indices",
          "index " + std::to_string(corners[i]) + " at " + std::to_string(i) + " is beyond the vertices",
          "below " + std::to_string(vertices) + "; there is no primitive restart in glTF");
  return corners;
}

void check_colors(const Mesh& mesh, const Document& document, uint32_t accessor) {
  for (const FloatStream& stream : mesh.color)
    for (size_t v = 0; v < stream.size(); ++v)
      if (!(stream[v] >= 0.0f && stream[v] <= 1.0f))
        document.fail(pointer_to("accessors", accessor),
                      "the colour of vertex " + std::to_string(v) + " is out of range", "numbers from 0 to 1");
}

/// Three corners a triangle.
std::vector<uint32_t> triangles_of(Accessors& accessors, std::vector<uint32_t> corners, Mode mode,
                                   const std::string& pointer) {
  if (mode == Mode::triangles) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<uint32_t> triangles;
  if (corners.size() < 3) return triangles;
  accessors.take(3 * (uint64_t(corners.size()) - 2) * sizeof(uint32_t), pointer);
  triangles.reserve(3 * (corners.size() - 2));
  for (size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == Mode::triangle_strip)
      triangles.insert(triangles.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else
      triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
  }
  return triangles;
}

/// `each` values an element, an element for each of `corners` in turn.
template <class Values>  // a vector or an Array
void take_apart(Values& values, std::span<const uint32_t> corners, size_t each = 1) {
  if (values.empty()) return;
  std::vector<typename Values::value_type> out;
  out.reserve(corners.size() * each);
  for (const uint32_t corner : corners)
    out.insert(out.end(), values.begin() + ptrdiff_t(corner * each), values.begin() + ptrdiff_t((corner + 1) * each));
  values = std::move(out);
}

void read_uv_sets(Accessors& accessors, const Attributes& from, size_t count, Mesh& mesh) {
  if (count > 1) mesh.more_uv.resize(count - 1);
  for (size_t set = 0; set < count; ++set)
    read_streams(accessors, from.uv_set(set), set == 0 ? mesh.uv : mesh.more_uv[set - 1]);
}

bool reads_tangents(const Primitive& primitive, Wanted wanted) {
  return wanted.tangents && primitive.attributes.tangent != kNone && primitive.attributes.normal != kNone;
}

/// The sign of w is what counts.
void read_tangents(Accessors& accessors, const Primitive& primitive, Mesh& mesh) {
  read_streams(accessors, primitive.attributes.tangent, mesh.tangent);
  for (float& side : mesh.tangent[3]) side = side < 0.0f ? -1.0f : 1.0f;
}

void read_targets(Accessors& accessors, const Primitive& primitive, bool tangents, RestShape& shape) {
  for (const Attributes& from : primitive.targets) {
    MorphTarget& target = shape.targets.emplace_back();
    read_streams(accessors, from.position, target.position);
    read_streams(accessors, from.normal, target.normal);
    if (tangents) read_streams(accessors, from.tangent, target.tangent);
  }
}

/// Sets of four joints and weights, side by side for each vertex.
void read_influences(Accessors& accessors, const Attributes& attributes, size_t vertices, RestShape& shape) {
  shape.influences = uint32_t(4 * attributes.joints.size());
  shape.joints.resize(vertices * shape.influences);
  shape.weights.resize(vertices * shape.influences);
  for (uint32_t k = 0; k < shape.influences; ++k) {
    const std::vector<uint32_t> joints = accessors.integers(attributes.joints[k / 4], k % 4);
    const std::vector<float> weights = accessors.floats(attributes.weights[k / 4], k % 4);
    for (size_t v = 0; v < vertices; ++v) {
      if (weights[v] < 0.0f)
        accessors.document().fail(pointer_to("accessors", attributes.weights[k / 4]),
                                  "the weight of vertex " + std::to_string(v) + " is below 0", "weights from 0 on");
      shape.joints[v * shape.influences + k] = uint16_t(joints[v]);
      shape.weights[v * shape.influences + k] = weights[v];
    }
  }
}

}  // namespace

void plan_geometry(Accessors& accessors, const Primitive& primitive, Wanted wanted) {
  const auto plan = [&accessors](uint32_t accessor, uint32_t most) {
    if (accessor != kNone) accessors.plan(accessor, std::min(most, components_of(accessors.at(accessor).shape)));
  };
  const Attributes& from = primitive.attributes;
  plan(from.position, 3), plan(from.normal, 3);
  for (size_t set = 0; set < wanted.uv_sets; ++set) plan(from.uv_set(set), 2);
  plan(from.color, 4);
  const bool tangents = reads_tangents(primitive, wanted);
  if (tangents) plan(from.tangent, 4);
  for (const Attributes& target : primitive.targets) {
    plan(target.position, 3), plan(target.normal, 3);
    if (tangents) plan(target.tangent, 3);
  }
  for (size_t set = 0; set < from.joints.size(); ++set) plan(from.joints[set], 4), plan(from.weights[set], 4);
  plan(primitive.indices, 1);
}

void drop_unused_vertices(Mesh& mesh) {
  constexpr size_t kFew = 1000;
  const size_t vertices = mesh.vertex_count();
  if (vertices < kFew) return;
  std::vector<uint32_t> place(vertices, 0);  // first whether a vertex is kept, then where
  for (const uint32_t index : mesh.indices) place[index] = 1;
  for (const FloatStream& stream : mesh.position) {
    const auto [least, most] = std::minmax_element(stream.begin(), stream.end());
    place[size_t(least - stream.begin())] = place[size_t(most - stream.begin())] = 1;
  }
  std::vector<uint32_t> kept;
  for (uint32_t v = 0; v < vertices; ++v) {
    if (place[v] == 0) continue;
    place[v] = uint32_t(kept.size());
    kept.push_back(v);
  }
  if (kept.size() >= vertices / 4) return;
  const auto keep = [&kept](auto& streams) {
    for (FloatStream& stream : streams) take_apart(stream, kept);
  };
  keep(mesh.position), keep(mesh.normal), keep(mesh.uv), keep(mesh.color), keep(mesh.tangent);
  for (auto& set : mesh.more_uv) keep(set);
  for (uint32_t& index : mesh.indices) index = place[index];
}

void add_tangents(const UvSource& normal_map, Geometry& geometry) {
  Mesh& mesh = geometry.mesh;
  RestShape& shape = geometry.shape;
  const std::vector<uint32_t> from = add_mikk_tangents(baked(mesh.uv_set(normal_map.set), normal_map.transform), mesh);
  if (shape.targets.empty() && shape.influences == 0) return;
  shape.position = mesh.position, shape.normal = mesh.normal;
  std::copy_n(mesh.tangent.begin(), 3, shape.tangent.begin());
  for (MorphTarget& target : shape.targets)
    for (auto* streams : {&target.position, &target.normal})
      for (FloatStream& stream : *streams) take_apart(stream, from);
  take_apart(shape.joints, from, shape.influences);
  take_apart(shape.weights, from, shape.influences);
}

Geometry read_geometry(Accessors& accessors, const Primitive& primitive, Wanted wanted, const std::string& pointer) {
  Geometry out;
  const Attributes& from = primitive.attributes;
  Mesh& mesh = out.mesh;
  RestShape& shape = out.shape;
  read_streams(accessors, from.position, mesh.position);
  read_streams(accessors, from.normal, mesh.normal);
  read_uv_sets(accessors, from, wanted.uv_sets, mesh);
  read_streams(accessors, from.color, mesh.color);
  const size_t vertices = mesh.vertex_count();
  if (mesh.has_color() && mesh.color[3].empty()) mesh.color[3].assign(vertices, 1.0f);
  check_colors(mesh, accessors.document(), from.color);
  const bool tangents = reads_tangents(primitive, wanted);
  if (tangents) read_tangents(accessors, primitive, mesh);
  read_targets(accessors, primitive, tangents, shape);
  if (!from.joints.empty()) read_influences(accessors, from, vertices, shape);
  mesh.indices =
      triangles_of(accessors, read_corners(accessors, primitive, vertices, pointer), primitive.mode, pointer);
  if (from.normal == kNone) {
    accessors.take(uint64_t(mesh.indices.size()) * 4 * (12 + 6 * primitive.targets.size() + 2 * shape.influences),
                   pointer);
    shape.flat_normals = true;
    for (MorphTarget& target : shape.targets)
      for (auto& stream : target.position) take_apart(stream, mesh.indices);
    take_apart(shape.joints, mesh.indices, shape.influences);
    take_apart(shape.weights, mesh.indices, shape.influences);
    add_normals(mesh, MissingNormals::flat);
  }
  if (!shape.targets.empty() || shape.influences > 0) {
    shape.position = mesh.position, shape.normal = mesh.normal;
    std::copy_n(mesh.tangent.begin(), 3, shape.tangent.begin());
  }
  return out;
}

}  // namespace trueshade::gltf
