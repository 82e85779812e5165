// Tangents of glTF meshes: those of the file, and those of MikkTSpace where it has none.
#include <cmath>

#include "asset.h"
#include "round_trip.h"
#include "scenes/files/gltf/mikk_tangents.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

using Floats = std::vector<float>;
using Four = std::array<float, 4>;

const Floats kNormals{0, 0, 1, 0, 0, 1, 0, 0, 1}, kUv{0, 1, 1, 1, 0, 0};
const Floats kTangents{1, 0, 0, 1, 0.5f, 0.25f, 0, -0.3f, 0, 2, 0, 0};

/// Lists of a triangle's document behind its buffer: `attributes` are JSON, accessors 0 to 3 are positions, normals,
/// texture coordinates and tangents.
std::string lists(const std::string& attributes, const std::string& material, const std::string& more = "",
                  const std::string& primitive_more = "") {
  return R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)" + more +
         R"(}], "meshes": [{"primitives": [{"attributes": {)" + attributes + R"(}, "material": 0)" + primitive_more +
         R"(}]}], "materials": [{)" + material +
         R"(}], "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,)" +
         base64(plain_picture(1, 1, "aaaa")) + R"("}])";
}

Asset triangle() {
  Asset asset;
  asset.accessor(kTriangle, "VEC3"), asset.accessor(kNormals, "VEC3"), asset.accessor(kUv, "VEC2");
  asset.accessor(kTangents, "VEC4");
  return asset;
}

const std::string kAll = R"("POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3)";
const std::string kWithout = R"("POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2)";
const std::string kBumps = R"("normalTexture": {"index": 0})";

Four tangent(const Mesh& mesh, size_t v) {
  return {mesh.tangent[0][v], mesh.tangent[1][v], mesh.tangent[2][v], mesh.tangent[3][v]};
}

TEST_CASE("tangents of a file are read where a normal map is, and of their w the sign") {
  const Scene scene = load_gltf(triangle().gltf(lists(kAll, kBumps)));
  const Mesh& mesh = scene.meshes.at(0);
  REQUIRE(mesh.has_tangents());
  CHECK(tangent(mesh, 0) == Four{1, 0, 0, 1});
  CHECK(tangent(mesh, 1) == Four{0.5f, 0.25f, 0, -1});
  CHECK(tangent(mesh, 2) == Four{0, 2, 0, 1});
  const Scene level = load_gltf(triangle().gltf(lists(kAll, R"("name": "level")")));
  CHECK_FALSE(level.meshes.at(0).has_tangents());
  CHECK(scene_hash(level) == scene_hash(load_gltf(triangle().gltf(lists(kWithout, R"("name": "level")")))));
  Scene other = scene;
  other.meshes[0].tangent[3][0] = -1.0f;
  CHECK(scene_hash(other) != scene_hash(scene));
  other.meshes[0].tangent = {};
  CHECK(scene_hash(other) != scene_hash(scene));
}

TEST_CASE("tangents survive an export") {
  const Scene scene = load_gltf(triangle().gltf(lists(kAll, kBumps)));
  const Scene again = written_and_loaded(scene);
  CHECK(scene_hash(again) == scene_hash(scene));
  CHECK(tangent(again.meshes.at(0), 1) == tangent(scene.meshes.at(0), 1));
  Scene without = scene;  // MikkTSpace is for files of others
  without.meshes[0].tangent = {};
  CHECK_FALSE(written_and_loaded(without).meshes.at(0).has_tangents());
}

TEST_CASE("a scene file that draws a model without its tangents says so, once, where a normal map shows it") {
  const auto notes = [](const std::string& material) {
    const ScratchFolder folder;
    folder.write("a.gltf", triangle().gltf(lists(kAll, material)));
    folder.write("s.json", R"({"version": 1, "objects": [{"geometry": "a.gltf"}, {"geometry": "a.gltf"}]})");
    std::vector<std::string> found = load_scene(folder.path("s.json"), {}, decode_plain).notes;
    std::erase_if(found, [](const std::string& note) { return note.find("tangents") == std::string::npos; });
    return found;
  };
  const std::vector<std::string> said = notes(kBumps);
  REQUIRE(said.size() == 1);
  CHECK(said[0].starts_with("Normal maps of a.gltf follow the texture coordinates"));
  CHECK(notes(R"("name": "level")").empty());
}

TEST_CASE("without normals the tangents of a file are left out, and made along the flat ones") {
  const Scene scene = load_gltf(triangle().gltf(lists(R"("POSITION": 0, "TEXCOORD_0": 2, "TANGENT": 3)", kBumps)));
  for (size_t v = 0; v < 3; ++v) CHECK(tangent(scene.meshes.at(0), v) == Four{1, 0, 0, 1});
}

TEST_CASE("tangents that are not finite are refused, and so are those whose w is none in a scene") {
  Asset asset = triangle();
  asset.accessor(Floats{1, 0, 0, 1, INFINITY, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  const std::string said =
      gltf_refusal(asset.gltf(lists(R"("POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 4)", kBumps)));
  CHECK(said.find("/accessors/4") != std::string::npos);
  Scene scene = load_gltf(triangle().gltf(lists(kAll, kBumps)));
  scene.meshes[0].tangent[3][1] = 0.5f;
  CHECK_THROWS_AS(validate(scene), Error);
}

TEST_CASE("morph targets move tangents, and joints turn them") {
  Asset asset = triangle();
  asset.accessor(Floats{0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3");
  asset.accessor(Floats{0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  const Scene morphed = load_gltf(
      asset.gltf(lists(kAll, kBumps, R"(, "weights": [1])", R"(, "targets": [{"POSITION": 4, "TANGENT": 5}])")));
  const float half = float(1.0 / std::sqrt(2.0));
  CHECK(tangent(morphed.meshes.at(0), 0) == Four{half, half, 0, 1});
  CHECK(tangent(morphed.meshes.at(0), 2) == Four{0, 1, 0, 1});  // of unit length, as normals that move are
  Asset bones = triangle();
  bones.accessor(std::vector<uint8_t>(12, 0), "VEC4");
  bones.accessor(Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const std::string attributes = kAll + R"(, "JOINTS_0": 4, "WEIGHTS_0": 5)";
  std::string document = lists(attributes, kBumps, R"(, "skin": 0)");
  const std::string from = R"("nodes": [{"mesh": 0, "skin": 0}])";
  const size_t at = document.find(from);
  REQUIRE(at != std::string::npos);
  // A quarter turn about z, twice as large.
  document.replace(
      at, from.size(),
      R"("nodes": [{"mesh": 0, "skin": 0}, {"matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}])");
  document.replace(document.find(R"({"nodes": [0]})"), 14, R"({"nodes": [0, 1]})");
  const Scene skinned = load_gltf(bones.gltf(document + R"(, "skins": [{"joints": [1]}])"));
  CHECK(tangent(skinned.meshes.at(0), 0) == Four{0, 1, 0, 1});
}

// --- MikkTSpace ----------------------------------------------------------------------------------------------------

/// A mesh in the plane z = 0 whose normals are z; (x, y, u, v) a vertex.
Mesh flat(const std::vector<Four>& vertices, const std::vector<uint32_t>& indices) {
  Mesh mesh;
  for (const Four& v : vertices) {
    mesh.position[0].push_back(v[0]), mesh.position[1].push_back(v[1]), mesh.position[2].push_back(0.0f);
    mesh.normal[0].push_back(0.0f), mesh.normal[1].push_back(0.0f), mesh.normal[2].push_back(1.0f);
    mesh.uv[0].push_back(v[2]), mesh.uv[1].push_back(v[3]);
  }
  mesh.indices = indices;
  return mesh;
}

/// Made, and how many vertices were added.
size_t make(Mesh& mesh) {
  const size_t before = mesh.vertex_count();
  const std::vector<uint32_t> from = gltf::add_mikk_tangents(mesh.uv, mesh);
  CHECK(from.size() == mesh.vertex_count());
  return mesh.vertex_count() - before;
}

void check_near(const Four& found, double x, double y, double z, float w) {
  CAPTURE(found[0], found[1], found[2], found[3], x, y, z, w);
  CHECK(std::fabs(double(found[0]) - x) < 1e-7);
  CHECK(std::fabs(double(found[1]) - y) < 1e-7);
  CHECK(std::fabs(double(found[2]) - z) < 1e-7);
  CHECK(found[3] == w);
}

TEST_CASE("a picture laid on a square has its red to the right and its green up") {
  // Row 0 of a picture lies at v = 0: v runs down.
  Mesh square = flat({{0, 0, 0, 1}, {1, 0, 1, 1}, {1, 1, 1, 0}, {0, 1, 0, 0}}, {0, 1, 2, 0, 2, 3});
  CHECK(make(square) == 0);
  for (size_t v = 0; v < 4; ++v) CHECK(tangent(square, v) == Four{1, 0, 0, 1});
  Mesh mirrored = flat({{0, 0, 1, 1}, {1, 0, 0, 1}, {1, 1, 0, 0}, {0, 1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  CHECK(make(mirrored) == 0);
  for (size_t v = 0; v < 4; ++v) CHECK(tangent(mirrored, v) == Four{-1, 0, 0, -1});
}

TEST_CASE("tangents of triangles around a vertex are weighted by their angles there") {
  // u along (1, 0) in the first, 90 degrees wide at vertex 0, and along (1, 1) in the second, 45 degrees wide.
  Mesh mesh = flat({{0, 0, 0, 0}, {1, 0, 1, 0}, {0, 1, 0, 1}, {-1, 1, -1, 2}}, {0, 1, 2, 0, 2, 3});
  CHECK(make(mesh) == 0);
  const double r = std::sqrt(0.5);
  const auto check = [&](size_t v, double first, double second) {
    const double x = first + second * r, y = second * r, length = std::hypot(x, y);
    check_near(tangent(mesh, v), x / length, y / length, 0, -1.0f);
  };
  check(0, 90, 45);
  check(1, 1, 0);
  check(2, 45, 90);  // the first triangle has 45 degrees there
  check(3, 0, 1);
}

TEST_CASE("tangents are laid into the plane across the vertex's normal before they are added") {
  // A roof over x from -1 to 1 whose ridge has the normal z, u along x on both sides.
  Mesh roof = flat({{-1, 0, -1, 0}, {0, 0, 0, 0}, {0, 1, 0, -1}, {1, 0, 1, 0}}, {0, 1, 2, 1, 3, 2});
  roof.position[2] = {{-1.0f, 0.0f, 0.0f, -1.0f}};
  CHECK(make(roof) == 0);
  check_near(tangent(roof, 1), 1, 0, 0, 1.0f);
  check_near(tangent(roof, 2), 1, 0, 0, 1.0f);
}

TEST_CASE("a vertex on a line where the texture is mirrored becomes two") {
  Mesh mesh = flat({{-1, 0, 1, 1}, {0, 0, 0, 1}, {1, 0, 1, 1}, {1, 1, 1, 0}, {0, 1, 0, 0}, {-1, 1, 1, 0}},
                   {0, 1, 4, 0, 4, 5, 1, 2, 3, 1, 3, 4});
  for (size_t c = 0; c < 4; ++c)
    for (int v = 0; v < 6; ++v) mesh.color[c].push_back(float(v));
  const Mesh before = mesh;
  CHECK(make(mesh) == 2);
  for (size_t i = 0; i < 12; ++i) {
    const uint32_t v = mesh.indices[i], was = before.indices[i];
    CHECK(mesh.position[0][v] == before.position[0][was]);
    CHECK(mesh.color[2][v] == float(was));
    CHECK(tangent(mesh, v) == (i < 6 ? Four{-1, 0, 0, -1} : Four{1, 0, 0, 1}));
  }
}

TEST_CASE("vertices that are equal but stand twice in a file share their tangent") {
  Mesh mesh =
      flat({{0, 0, 0, 0}, {1, 0, 1, 0}, {0, 1, 0, 1}, {0, 0, 0, 0}, {0, 1, 0, 1}, {-1, 1, -1, 2}}, {0, 1, 2, 3, 4, 5});
  CHECK(make(mesh) == 0);
  CHECK(tangent(mesh, 0) == tangent(mesh, 3));
  CHECK(tangent(mesh, 2) == tangent(mesh, 4));
  CHECK(tangent(mesh, 1) != tangent(mesh, 5));
}

TEST_CASE("triangles without area take the tangents of others, and alone have the x axis") {
  Mesh mesh = flat({{0, 0, 0, 1}, {0, 1, 0, 0}, {1, 0, 1, 1}, {5, 5, 2, 2}, {6, 5, 2, 2}, {5, 6, 2, 2}},
                   {0, 0, 1, 0, 2, 1, 3, 4, 5, 3, 3, 4});
  CHECK(make(mesh) == 0);
  for (size_t v = 0; v < 3; ++v) CHECK(tangent(mesh, v) == Four{1, 0, 0, 1});
  for (size_t v = 3; v < 6; ++v) CHECK(tangent(mesh, v) == Four{1, 0, 0, 1});  // uv without area
}

}  // namespace
}  // namespace trueshade
