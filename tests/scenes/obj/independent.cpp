#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <tiny_obj_loader.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>

#include "core/image.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/files/obj/obj_scene.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

// Valid files read by loaders that others wrote: tinyobjloader for corners and materials, assimp for meshes.
namespace trueshade {
namespace {

std::string assets() {
  const char* given = std::getenv("TRUESHADE_ASSETS");
  return given ? given : TRUESHADE_SOURCE_DIR "/../shared/assets";
}

/// White pictures stand in for those that materials name.
Image white(std::span<const uint8_t>, const std::string&, uint64_t) {
  Image image(1, 1, Format::rgba8);
  image.texels.assign(4, 255);
  return image;
}

Scene ours(const std::string& path) {
  const Bytes file = read_user_file(path, uint64_t(1) << 30);
  return scene_from_obj(file, path, {}, white, MissingNormals::creased);
}

/// A corner of a triangle: position, texture coordinate, normal, and the material's name.
struct PeerCorner {
  glm::vec3 position;
  glm::vec2 uv;
  std::optional<glm::vec3> normal;
};

/// Corners of all triangles by material, in the file's order.
using ByMaterial = std::map<std::string, std::vector<PeerCorner>>;

ByMaterial corners_of(const Scene& scene) {
  ByMaterial out;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<PeerCorner>& corners = out[scene.materials[instance.material].name];
    for (const uint32_t i : mesh.indices)
      corners.push_back({{mesh.position[0][i], mesh.position[1][i], mesh.position[2][i]},
                         mesh.has_uv() ? glm::vec2(mesh.uv[0][i], mesh.uv[1][i]) : glm::vec2(0.0f),
                         glm::vec3(mesh.normal[0][i], mesh.normal[1][i], mesh.normal[2][i])});
  }
  return out;
}

struct Peer {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;

  explicit Peer(const std::string& path) {
    std::string warning, error;
    const std::string folder = std::filesystem::path(path).parent_path().string() + "/";
    REQUIRE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, path.c_str(), folder.c_str(), false));
  }

  PeerCorner corner(const tinyobj::index_t& i) const {
    PeerCorner out{};
    for (int k = 0; k < 3; ++k) out.position[k] = attributes.vertices[size_t(3 * i.vertex_index + k)];
    for (int k = 0; k < 2 && i.texcoord_index >= 0; ++k)
      out.uv[k] = attributes.texcoords[size_t(2 * i.texcoord_index + k)];
    if (i.normal_index < 0) return out;
    out.normal.emplace();
    for (int k = 0; k < 3; ++k) (*out.normal)[k] = attributes.normals[size_t(3 * i.normal_index + k)];
    return out;
  }

  /// A corner whose texture coordinates the options -s and -o of the material's picture have changed.
  PeerCorner moved(PeerCorner corner, int material) const {
    if (material < 0) return corner;
    const tinyobj::texture_option_t& option = materials[size_t(material)].diffuse_texopt;
    for (int k = 0; k < 2; ++k) corner.uv[k] = option.origin_offset[k] + option.scale[k] * corner.uv[k];
    return corner;
  }

  /// Polygons as fans, which they are here where they are convex. `concave` counts polygons that are left out.
  ByMaterial corners() const {
    ByMaterial out;
    for (const tinyobj::shape_t& shape : shapes) {
      size_t first = 0;
      for (size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face) {
        const int id = shape.mesh.material_ids[face];
        std::vector<PeerCorner>& to = out[id < 0 ? "" : materials[size_t(id)].name];
        const size_t count = size_t(shape.mesh.num_face_vertices[face]);
        for (size_t i = 2; i < count; ++i)
          for (const size_t k : {size_t(0), i - 1, i}) to.push_back(moved(corner(shape.mesh.indices[first + k]), id));
        first += count;
      }
    }
    return out;
  }
};

bool is_near(float a, float b) { return std::fabs(a - b) <= 1e-6f * std::max(1.0f, std::fabs(b)); }

/// How many corners differ by more than the peer's number reader rounds.
size_t differing(const std::vector<PeerCorner>& ours, const std::vector<PeerCorner>& peer) {
  size_t count = 0;
  for (size_t i = 0; i < ours.size(); ++i) {
    bool same = true;
    for (int k = 0; k < 3; ++k) same = same && is_near(ours[i].position[k], peer[i].position[k]);
    for (int k = 0; k < 2; ++k) same = same && is_near(ours[i].uv[k], peer[i].uv[k]);
    for (int k = 0; k < 3 && peer[i].normal; ++k) same = same && is_near((*ours[i].normal)[k], (*peer[i].normal)[k]);
    count += !same;
  }
  return count;
}

void check_equal_corners(const std::string& path, const std::string& no_material) {
  const Scene scene = ours(path);
  const Peer peer(path);
  ByMaterial left = corners_of(scene), right = peer.corners();
  if (right.contains("")) right[no_material] = std::move(right[""]), right.erase("");
  REQUIRE(left.size() == right.size());
  for (const auto& [name, corners] : right) {
    CAPTURE(name);
    REQUIRE(left.contains(name));
    REQUIRE(left[name].size() == corners.size());
    CHECK(differing(left[name], corners) == 0);
  }
}

/// Random vertices and triangles in every form of corner, with groups, objects and materials between them.
std::string random_file(uint64_t seed) {
  Pcg32 random(seed, 3);
  std::string text = "mtllib r.mtl\n";
  const auto number = [&] { return std::to_string(20.0 * random.real() - 10.0); };
  uint32_t counts[3] = {0, 0, 0};
  for (int round = 0; round < 40; ++round) {
    for (uint32_t i = 0; i < 3 + random.below(5); ++i, ++counts[0])
      text += "v " + number() + ' ' + number() + ' ' + number() + '\n';
    for (uint32_t i = 0; i < 2; ++i, ++counts[1]) text += "vt " + number() + ' ' + number() + '\n';
    for (uint32_t i = 0; i < 2; ++i, ++counts[2]) text += "vn " + number() + ' ' + number() + ' ' + number() + '\n';
    if (random.below(3) == 0) text += "g group " + std::to_string(round) + '\n';
    if (random.below(4) == 0) text += "o object" + std::to_string(round) + '\n';
    if (round == 0 || random.below(2) == 0) text += "usemtl m" + std::to_string(random.below(4)) + '\n';
    for (int face = 0; face < 4; ++face) {
      const uint32_t form = random.below(4);
      text += 'f';
      for (int corner = 0; corner < 3; ++corner) {
        const auto index = [&](int k) {
          const int64_t i = int64_t(random.below(counts[k])) + 1;
          return std::to_string(random.below(2) == 0 ? i : i - int64_t(counts[k]) - 1);
        };
        text += ' ' + index(0);
        if (form == 1 || form == 3) text += '/' + index(1);
        if (form == 2) text += '/';
        if (form >= 2) text += '/' + index(2);
      }
      text += '\n';
    }
  }
  return text;
}

constexpr const char* kLibrary =
    "newmtl m0\nKd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nNs 10\nd 0.5\nillum 2\nmap_Kd -s 2 2 1 a.png\n"
    "newmtl m1\nKd 1 1 1\nKe 2 3 4\nPr 0.25\nPm 0.75\nmap_Ks b c.png\nnewmtl m2\nKd 0 0 0\nKs 0 0 0\nTr 0.75\nnewmtl "
    "m3\nKd 1 0 0\nKs 1 1 1\nNs 200\n";

TEST_CASE("OBJ, independent: corners of 60 random files are tinyobjloader's") {
  const ScratchFolder folder;
  folder.write("r.mtl", kLibrary);
  for (const char* name : {"a.png", "b c.png"}) folder.write(name, "");
  for (uint64_t seed = 0; seed < 60; ++seed) check_equal_corners(folder.write("r.obj", random_file(seed)), "grey");
}

TEST_CASE("OBJ, independent: numbers of materials are tinyobjloader's") {
  const ScratchFolder folder;
  folder.write("r.mtl", kLibrary);
  for (const char* name : {"a.png", "b c.png"}) folder.write(name, "");
  const std::string path = folder.write("r.obj", random_file(1));
  const Scene scene = ours(path);
  const Peer peer(path);
  REQUIRE(peer.materials.size() == 4);
  REQUIRE(scene.materials.size() == 4);
  for (const tinyobj::material_t& theirs : peer.materials) {
    CAPTURE(theirs.name);
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const Material& m) { return m.name == theirs.name; });
    REQUIRE(found != scene.materials.end());
    for (int k = 0; k < 3; ++k) {
      CHECK(found->base_color[k] == Approx(theirs.diffuse[k]));
      CHECK(found->specular_color[k] == Approx(theirs.name == "m1" ? 1.0f : theirs.specular[k]));  // map_Ks alone
      CHECK(found->emission[k] == Approx(theirs.emission[k]));
    }
    CHECK(found->base_color.w == Approx(theirs.dissolve));
    if (theirs.name == "m0" || theirs.name == "m3") CHECK(found->shininess == theirs.shininess);
    if (theirs.name == "m1") CHECK(found->roughness == theirs.roughness);
    CHECK(found->metallic == theirs.metallic);
    CHECK(found->color_map.used() == !theirs.diffuse_texname.empty());
    CHECK(found->specular_map.used() == !theirs.specular_texname.empty());
  }
}

TEST_CASE("OBJ, independent: assimp finds the triangles and positions of random files") {
  const ScratchFolder folder;
  folder.write("r.mtl", kLibrary);
  for (const char* name : {"a.png", "b c.png"}) folder.write(name, "");
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const std::string path = folder.write("r.obj", random_file(seed));
    Assimp::Importer importer;
    const aiScene* peer = importer.ReadFile(path, aiProcess_Triangulate);
    REQUIRE(peer);
    std::map<std::string, std::vector<glm::vec3>> theirs;
    size_t triangles = 0;
    double sum = 0.0, our_sum = 0.0;
    for (unsigned m = 0; m < peer->mNumMeshes; ++m)
      for (unsigned f = 0; f < peer->mMeshes[m]->mNumFaces; ++f, ++triangles)
        for (unsigned k = 0; k < 3; ++k) {
          const aiVector3D& p = peer->mMeshes[m]->mVertices[peer->mMeshes[m]->mFaces[f].mIndices[k]];
          sum += double(p.x) + 2.0 * double(p.y) + 3.0 * double(p.z);
        }
    const Scene scene = ours(path);
    CHECK(scene.triangle_count() == triangles);
    for (const auto& [name, corners] : corners_of(scene))
      for (const PeerCorner& c : corners)
        our_sum += double(c.position.x) + 2.0 * double(c.position.y) + 3.0 * double(c.position.z);
    CHECK(our_sum == Approx(sum).epsilon(1e-6));
  }
}

TEST_CASE("OBJ, independent: a cow and a palace") {
  const std::string spot = assets() + "/spot/spot_triangulated.obj", sponza = assets() + "/sponza/sponza.obj.gz";
  if (!std::filesystem::exists(spot) || !std::filesystem::exists(sponza)) {
    WARN("SKIPPED: there is no " + spot + " or no " + sponza);
    return;
  }
  check_equal_corners(spot, "grey");
  const ScratchFolder folder;
  for (const char* part : {"sponza.mtl", "textures"})
    std::filesystem::create_symlink(std::filesystem::absolute(assets() + "/sponza/" + part), folder.path(part));
  const Bytes unpacked = gunzipped(read_user_file(sponza, 1u << 30), {}, sponza);
  const std::string path =
      folder.write("sponza.obj", {reinterpret_cast<const char*>(unpacked.data()), unpacked.size()});
  const Peer peer(path);
  const Scene scene = ours(sponza);
  size_t triangles = 0, with_material = 0;
  for (const tinyobj::shape_t& shape : peer.shapes)
    for (size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face)
      triangles += size_t(shape.mesh.num_face_vertices[face]) - 2, with_material += shape.mesh.material_ids[face] >= 0;
  CHECK(scene.triangle_count() == triangles);
  CHECK(with_material > 0);
  CHECK(scene.materials.size() == peer.materials.size() + 1);  // one that the library does not define
}

}  // namespace
}  // namespace trueshade
