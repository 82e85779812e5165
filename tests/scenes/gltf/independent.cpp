#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>

#include "asset.h"
#include "core/error.h"
#include "read_by_tinygltf.h"
#include "scenes/hierarchy.h"
#include "scenes/trig.h"
#include "tests/catch.hpp"

// Valid files read by loaders that others wrote: tinygltf for the numbers of accessors, assimp for what is made of
// them.
namespace trueshade {
namespace {

std::string assets() {
  const char* given = std::getenv("TRUESHADE_ASSETS");
  return given ? given : TRUESHADE_SOURCE_DIR "/../shared/assets";
}

// --- A file with every kind of data ----------------------------------------------------------------------------------

std::vector<float> ramp(size_t count, float from, float step) {
  std::vector<float> values;
  for (size_t i = 0; i < count; ++i) values.push_back(from + step * float(i));
  return values;
}

/// Two meshes, one of them quantized and sparse, on nodes that turn, move and grow.
std::string everything() {
  Asset asset;
  asset.accessor(ramp(36, -1.5f, 0.37f), "VEC3");  // 0: 12 positions
  asset.accessor(ramp(36, 1.0f, -0.05f), "VEC3");  // 1: normals
  asset.accessor(std::vector<uint16_t>{0,  65535, 1,  2,  300, 4000, 5,  60000, 7,  8,  9,  10,
                                       11, 12,    13, 14, 15,  16,   17, 18,    19, 20, 21, 22},
                 "VEC2", R"("normalized": true)");  // 2: texture coordinates
  asset.accessor(
      std::vector<uint8_t>{0, 1, 2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 0,  255, 128, 64, 32, 16, 8,  4,  2,  1,
                           7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33,  35,  37, 39, 41, 43, 45, 47, 49},
      "VEC4", R"("normalized": true)");                                          // 3: colours of 11 vertices
  asset.accessor(std::vector<uint16_t>{0, 1, 2, 2, 1, 3, 9, 10, 11}, "SCALAR");  // 4: indices
  const int at = asset.view(std::vector<uint8_t>{3, 7}), values = asset.view(ramp(6, 50.0f, 0.5f));
  asset.accessor(
      R"("bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3", "sparse": {"count": 2, "indices": {"bufferView": )" +
      std::to_string(at) + R"(, "componentType": 5121}, "values": {"bufferView": )" + std::to_string(values) +
      "}}");                                                                              // 5
  asset.accessor(std::vector<float>{0, 0.5f, 2}, "SCALAR", R"("min": [0], "max": [2])");  // 6: times
  asset.accessor(ramp(9, 1.0f, 0.75f), "VEC3");                                           // 7: moves
  const float h = float(std::sqrt(0.5));
  asset.accessor(std::vector<float>{0, 0, 0, 1, 0, h, 0, h, 0.6f, 0, 0.8f, 0}, "VEC4");  // 8: turns
  asset.accessor(ramp(9, 1.0f, 0.25f), "VEC3");                                          // 9: scales
  asset.accessor(ramp(36, 0.1f, 0.01f), "VEC3");  // 10: normals of the second mesh
  return asset.glb(R"("scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "root", "children": [1, 2], "rotation": [0.6, 0, 0, 0.8], "translation": [1, 2, 3]},
              {"name": "moved", "mesh": 0}, {"name": "matrix", "mesh": 1, "matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 7, 8, 9, 1], "children": [3]},
              {"name": "leaf", "mesh": 0, "scale": [-1, 2, 0.5]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 4}]},
               {"primitives": [{"attributes": {"POSITION": 5, "NORMAL": 10}, "indices": 4}]}],
    "animations": [{"samplers": [{"input": 6, "output": 7}, {"input": 6, "output": 8}, {"input": 6, "output": 9, "interpolation": "STEP"}],
                    "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}, {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                                 {"sampler": 2, "target": {"node": 3, "path": "scale"}}]}])");
}

// --- tinygltf --------------------------------------------------------------------------------------------------------

/// An accessor's component as tinygltf's arrays hold it, by the format's formulas.
double peer_value(const tinygltf::Model& model, int accessor, size_t element, size_t component) {
  const tinygltf::Accessor& a = model.accessors.at(size_t(accessor));
  const auto number = [&](const tinygltf::BufferView& view, size_t offset, int type) -> double {
    const unsigned char* at = model.buffers.at(size_t(view.buffer)).data.data() + view.byteOffset + offset;
    const auto as = [&](auto value) {
      std::memcpy(&value, at, sizeof value);
      const double most = double(std::numeric_limits<decltype(value)>::max());
      return a.normalized ? std::max(double(value) / most, -1.0) : double(value);
    };
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return as(int8_t());
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return as(uint8_t());
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return as(int16_t());
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return as(uint16_t());
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return as(uint32_t());
      default:
        return as(float());
    }
  };
  const size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(a.componentType))),
               each = size_t(tinygltf::GetNumComponentsInType(uint32_t(a.type)));
  if (a.sparse.isSparse)
    for (int i = 0; i < a.sparse.count; ++i) {
      const auto& s = a.sparse;
      const tinygltf::BufferView &indices = model.bufferViews.at(size_t(s.indices.bufferView)),
                                 &values = model.bufferViews.at(size_t(s.values.bufferView));
      const size_t wide = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(s.indices.componentType)));
      if (number(indices, size_t(s.indices.byteOffset) + size_t(i) * wide, s.indices.componentType) == double(element))
        return number(values, size_t(s.values.byteOffset) + size_t(i) * size * each + component * size,
                      a.componentType);
    }
  const tinygltf::BufferView& view = model.bufferViews.at(size_t(a.bufferView));
  const size_t stride = view.byteStride != 0 ? view.byteStride : size * each;
  return number(view, a.byteOffset + element * stride + component * size, a.componentType);
}

/// A vertex is parted where triangles around it have different tangents, so that corners are compared.
template <size_t N>
void check_stream(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const char* name,
                  const std::array<FloatStream, N>& streams, const Mesh& mesh) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return;
  INFO(name);
  const size_t count = model.accessors[size_t(found->second)].count;
  REQUIRE((mesh.has_tangents() ? streams[0].size() >= count : streams[0].size() == count));
  for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const size_t v = size_t(peer_value(model, primitive.indices, corner, 0));
    for (size_t k = 0; k < N; ++k)
      if (streams[k][mesh.indices[corner]] != float(peer_value(model, found->second, v, k)))
        FAIL("component " << k << " of vertex " << v);
  }
}

/// All primitives, in the order of nodes that `meshes` lists, have the vertex data and indices of the peer.
void check_vertex_data(const std::string& path) {
  const Scene scene = load_scene(path, {}, [](std::span<const uint8_t>, const std::string&, uint64_t) {
    return Image(1, 1, Format::rgba8);  // pictures are not compared
  });
  const tinygltf::Model model = read_by_tinygltf(path);
  std::vector<const tinygltf::Primitive*> primitives;
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) primitives.push_back(&primitive);
  REQUIRE(scene.meshes.size() == primitives.size());
  for (size_t i = 0; i < primitives.size(); ++i) {
    INFO("primitive " << i);
    const tinygltf::Primitive& p = *primitives[i];
    const Mesh& mesh = scene.meshes[i];
    REQUIRE(mesh.indices.size() == model.accessors[size_t(p.indices)].count);
    check_stream(model, p, "POSITION", mesh.position, mesh);
    check_stream(model, p, "NORMAL", mesh.normal, mesh);
    check_stream(model, p, "TEXCOORD_0", mesh.uv, mesh);
    for (size_t k = 0; k < mesh.indices.size() && !mesh.has_tangents(); ++k)
      if (mesh.indices[k] != uint32_t(peer_value(model, p.indices, k, 0))) FAIL("index " << k);
  }
}

TEST_CASE("vertex data are those that tinygltf reads") {
  const ScratchFolder scratch;
  check_vertex_data(scratch.write("everything.glb", everything()));
}

// --- assimp ----------------------------------------------------------------------------------------------------------

glm::dmat4x3 matrix_of(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

/// Where each mesh is drawn, in the order of nodes.
void collect(const aiNode& node, const glm::dmat4x3& parent, std::vector<std::pair<unsigned, glm::dmat4x3>>& drawn) {
  const glm::dmat4x3 world = product(parent, matrix_of(node.mTransformation));
  for (unsigned i = 0; i < node.mNumMeshes; ++i) drawn.emplace_back(node.mMeshes[i], world);
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect(*node.mChildren[i], world, drawn);
}

/// Transforms are within a few ulps: assimp multiplies in float.
void check_transform(const glm::mat4x3& ours, const glm::dmat4x3& theirs, double tolerance = 2e-5) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r) {
      INFO("column " << c << ", row " << r << ": " << ours[c][r] << " and " << theirs[c][r]);
      CHECK(std::fabs(double(ours[c][r]) - theirs[c][r]) <= tolerance * (1.0 + std::fabs(theirs[c][r])));
    }
}

TEST_CASE("instances stand where assimp's nodes stand, and draw the same triangles") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("everything.glb", everything());
  const Scene scene = load_scene(path, {}, decode_plain);
  Assimp::Importer importer;
  const aiScene* peer = importer.ReadFile(path, 0);
  REQUIRE(peer != nullptr);
  std::vector<std::pair<unsigned, glm::dmat4x3>> drawn;
  collect(*peer->mRootNode, glm::dmat4x3(1.0), drawn);
  REQUIRE(drawn.size() == scene.instances.size());
  // The moved node rests at the identity, and the scene at time 0 shows its animation's first step.
  Scene rest = scene;
  rest.timeline.node_motions.clear();
  move_hierarchy(rest, 0.0);
  for (size_t i = 0; i < drawn.size(); ++i) {
    INFO("instance " << i);
    check_transform(rest.instances[i].world_from_object, drawn[i].second);
    const aiMesh& theirs = *peer->mMeshes[drawn[i].first];
    const Mesh& ours = scene.meshes[scene.instances[i].mesh];
    REQUIRE(theirs.mNumFaces == ours.triangle_count());
    for (unsigned f = 0; f < theirs.mNumFaces; ++f)
      for (unsigned k = 0; k < 3; ++k) {
        const uint32_t a = theirs.mFaces[f].mIndices[k], b = ours.indices[3 * f + k];
        CHECK(theirs.mVertices[a].x == ours.position[0][b]);
        CHECK(theirs.mVertices[a].y == ours.position[1][b]);
        CHECK(theirs.mVertices[a].z == ours.position[2][b]);
        CHECK(theirs.mNormals[a].z == ours.normal[2][b]);
      }
  }
}

/// A channel of assimp's at a time: lines between keys for moves, its slerp for turns.
template <typename Key>
std::pair<size_t, double> place_of(const Key* keys, unsigned count, double time) {
  size_t i = 0;
  while (i + 1 < count && keys[i + 1].mTime <= time) ++i;
  return {i, i + 1 < count ? (time - keys[i].mTime) / (keys[i + 1].mTime - keys[i].mTime) : 0.0};
}

TEST_CASE("animated poses are those of assimp's channels") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("everything.glb", everything());
  Scene scene = load_scene(path, {}, decode_plain);
  Assimp::Importer importer;
  const aiScene* peer = importer.ReadFile(path, 0);
  REQUIRE(peer != nullptr);
  REQUIRE(peer->mNumAnimations == 1);
  const aiAnimation& animation = *peer->mAnimations[0];
  const aiNodeAnim* moved = nullptr;
  for (unsigned i = 0; i < animation.mNumChannels; ++i)
    if (std::string(animation.mChannels[i]->mNodeName.C_Str()) == "moved") moved = animation.mChannels[i];
  REQUIRE(moved != nullptr);
  const double ticks = animation.mTicksPerSecond != 0.0 ? animation.mTicksPerSecond : 1.0;
  for (const double time : {0.0, 0.1, 0.25, 0.5, 0.75, 1.3, 1.9, 2.0}) {
    INFO("time " << time);
    set_time(scene, time);
    const auto [p, p_part] = place_of(moved->mPositionKeys, moved->mNumPositionKeys, time * ticks);
    const auto [r, r_part] = place_of(moved->mRotationKeys, moved->mNumRotationKeys, time * ticks);
    const aiVector3D a = moved->mPositionKeys[p].mValue,
                     b = moved->mPositionKeys[std::min<size_t>(p + 1, moved->mNumPositionKeys - 1)].mValue;
    aiQuaternion turn;
    aiQuaternion::Interpolate(turn, moved->mRotationKeys[r].mValue,
                              moved->mRotationKeys[std::min<size_t>(r + 1, moved->mNumRotationKeys - 1)].mValue,
                              ai_real(r_part));
    const aiMatrix4x4 local(aiVector3D(1, 1, 1), turn, a + (b - a) * ai_real(p_part));
    const aiNode* root = peer->mRootNode->FindNode("root");
    REQUIRE(root != nullptr);
    check_transform(scene.instances.at(0).world_from_object,
                    product(matrix_of(root->mTransformation), matrix_of(local)));
  }
}

TEST_CASE("Sponza's vertices are those that tinygltf reads") {
  const std::string path = assets() + "/sponza/sponza.gltf";
  if (!std::filesystem::exists(path)) {
    WARN("SKIPPED: " << path << " is absent; TRUESHADE_ASSETS names the folder of assets");
    return;
  }
  check_vertex_data(path);
}

}  // namespace
}  // namespace trueshade
