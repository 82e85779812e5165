#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>

#include "read_by_tinygltf.h"
#include "round_trip.h"
#include "scenes/builtin/builtin.h"
#include "tests/scratch_folder.h"

// Scenes written as GLB, read by loaders that others wrote.
namespace trueshade {
namespace {

std::string written(const ScratchFolder& folder, const Scene& scene) {
  const std::vector<uint8_t> bytes = glb_of_scene(scene, stored_picture).bytes;
  return folder.write("a.glb", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

size_t lights_with_place(const Scene& scene) {
  size_t count = 0;
  for (const Light& light : scene.lights) count += light.type != LightType::ambient;
  return count;
}

TEST_CASE("export, independent: tinygltf finds the objects, triangles, materials, textures, lights and the camera") {
  const ScratchFolder folder;
  for (const char* spec : {"city", "cornell", "lecture", "atrium,glass=1", "circle", "sphere"}) {
    CAPTURE(spec);
    const Scene scene = builtin_scene(spec);
    const tinygltf::Model model = read_by_tinygltf(written(folder, scene));
    CHECK(model.materials.size() == scene.materials.size());
    CHECK(model.images.size() == scene.textures.size());
    CHECK(model.lights.size() == lights_with_place(scene));
    CHECK(model.cameras.size() == 1);
    size_t objects = 0, cameras = 0;
    uint64_t triangles = 0;
    for (const int index : model.scenes.at(size_t(model.defaultScene)).nodes) {
      const tinygltf::Node& node = model.nodes.at(size_t(index));
      cameras += node.camera >= 0;
      if (node.mesh < 0) continue;
      const tinygltf::Primitive& p = model.meshes.at(size_t(node.mesh)).primitives.at(0);
      const Instance& instance = scene.instances.at(objects++);
      CHECK(p.material == int(instance.material));
      triangles += model.accessors.at(size_t(p.indices)).count / 3;
      const size_t vertices = model.accessors.at(size_t(p.attributes.at("POSITION"))).count;
      CHECK(vertices == scene.meshes[instance.mesh].vertex_count());
      for (int k = 0; k < 3; ++k)
        if (!node.matrix.empty()) CHECK(float(node.matrix[12 + size_t(k)]) == instance.world_from_object[3][k]);
    }
    CHECK(objects == scene.instances.size());
    CHECK(triangles == scene.triangle_count());
    CHECK(cameras == 1);
    for (size_t m = 0; m < model.materials.size(); ++m)
      for (int k = 0; k < 4; ++k)
        CHECK(model.materials[m].pbrMetallicRoughness.baseColorFactor[size_t(k)] ==
              double(scene.materials[m].base_color[k]));
  }
}

/// Sums of assimp's world positions of all triangles' corners.
void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, uint64_t& triangles,
              double (&sum)[3]) {
  const aiMatrix4x4 here = parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f, ++triangles)
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D at = here * mesh.mVertices[mesh.mFaces[f].mIndices[k]];
        sum[0] += double(at.x), sum[1] += double(at.y), sum[2] += double(at.z);
      }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) add_node(scene, *node.mChildren[c], here, triangles, sum);
}

TEST_CASE("export, independent: assimp finds the triangles where they stand, and the lights") {
  const ScratchFolder folder;
  for (const char* spec : {"city", "cornell", "circle"}) {
    CAPTURE(spec);
    const Scene scene = builtin_scene(spec);
    Assimp::Importer importer;
    const aiScene* peer = importer.ReadFile(written(folder, scene), 0);
    INFO(importer.GetErrorString());
    REQUIRE(peer);
    CHECK(peer->mNumLights == lights_with_place(scene));
    CHECK(peer->mNumCameras == 1);
    uint64_t triangles = 0;
    double theirs[3] = {}, ours[3] = {};
    add_node(*peer, *peer->mRootNode, aiMatrix4x4(), triangles, theirs);
    CHECK(triangles == scene.triangle_count());
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      const glm::dmat4x3 m(instance.world_from_object);
      for (const uint32_t i : mesh.indices)
        for (int r = 0; r < 3; ++r)
          ours[r] += m[0][r] * double(mesh.position[0][i]) + m[1][r] * double(mesh.position[1][i]) +
                     m[2][r] * double(mesh.position[2][i]) + m[3][r];
    }
    const double size = double(3 * triangles);
    for (int k = 0; k < 3; ++k) CHECK(std::fabs(theirs[k] - ours[k]) / size < 1e-4);
  }
}

}  // namespace
}  // namespace trueshade
