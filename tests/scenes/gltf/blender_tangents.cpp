// The tangents that are made for a model against those that Blender gave it. scripts/blender_tangents.py made
// data/blender_tangents.gltf with Blender 3.4.1, whose tangents come from its C++ version of the code of Morten S.
// Mikkelsen, who devised MikkTSpace.
#include <cmath>
#include <fstream>
#include <glm/vec3.hpp>
#include <sstream>

#include "asset.h"
#include "scenes/files/gltf/mikk_tangents.h"
#include "scenes/trig.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

/// Directions closer than this count as one. Blender weights a triangle by an estimate of its angle, a cubic polynomial
/// times a root, which is up to 4.5e-5 rad off; the largest difference is 4.2e-5 rad, in a fan with a triangle 3
/// degrees wide. Weights of the same estimate bring the largest difference to 3.3e-7 rad, the error of Blender's
/// floats.
constexpr double kSame_rad = 1e-4;

constexpr size_t kMeshes = 17;

std::string document() {
  std::ifstream file(TRUESHADE_SOURCE_DIR "/tests/scenes/gltf/data/blender_tangents.gltf");
  REQUIRE(file.good());
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The document with its tangents as an attribute of an application's own, which is not read.
std::string without_tangents(std::string document) {
  const std::string name = R"("TANGENT")";
  size_t found = 0;
  for (size_t at = document.find(name); at != std::string::npos; at = document.find(name, at), ++found)
    document.insert(at + 1, "_");
  REQUIRE(found == kMeshes);
  return document;
}

Scene loaded(const std::string& document) {
  const ScratchFolder folder;
  const auto decode = [](std::span<const uint8_t>, const std::string&, uint64_t) {
    return Image(1, 1, Format::rgba8);  // of the normal map, which no tangent depends on
  };
  Scene scene = load_scene(folder.write("a.gltf", document), {}, decode);
  REQUIRE(scene.meshes.size() == kMeshes);
  return scene;
}

/// How the tangents of two meshes differ that have the same triangles.
struct Difference {
  double angle_rad = 0.0;  ///< the largest between two directions
  size_t directions = 0;   ///< corners compared
  size_t signs = 0;        ///< corners at which w was compared
  size_t mirrored = 0;     ///< of these, corners at which w is -1
  size_t other_signs = 0;  ///< of these, corners at which w differs
};

bool has_uv_area(const Mesh& mesh, size_t triangle) {
  const uint32_t* const v = mesh.indices.data() + 3 * triangle;
  const auto change = [&](size_t k, size_t corner) { return double(mesh.uv[k][v[corner]]) - double(mesh.uv[k][v[0]]); };
  return change(0, 1) * change(1, 2) != change(0, 2) * change(1, 1);
}

glm::dvec3 direction(const Mesh& mesh, uint32_t v) {
  return {double(mesh.tangent[0][v]), double(mesh.tangent[1][v]), double(mesh.tangent[2][v])};
}

/// Compares corner by corner, since `made` may have more vertices than the file. A vertex of the file whose triangles
/// all lack area in uv is in no group of MikkTSpace: its direction is (1, 0, 0), and its w is arbitrary, so w is left
/// out there.
Difference difference(const Mesh& file, const Mesh& made) {
  REQUIRE(file.indices.size() == made.indices.size());
  std::vector<bool> in_group(file.vertex_count(), false);
  for (size_t corner = 0; corner < file.indices.size(); ++corner)
    if (has_uv_area(file, corner / 3)) in_group[file.indices[corner]] = true;
  Difference out;
  for (size_t corner = 0; corner < file.indices.size(); ++corner) {
    const uint32_t of_file = file.indices[corner], of_made = made.indices[corner];
    for (size_t k = 0; k < 3; ++k) REQUIRE(file.position[k][of_file] == made.position[k][of_made]);
    for (size_t k = 0; k < 2; ++k) REQUIRE(file.uv[k][of_file] == made.uv[k][of_made]);
    const glm::dvec3 a = direction(file, of_file), b = direction(made, of_made), c = cross(a, b);
    out.angle_rad = std::max(out.angle_rad, std::atan2(std::sqrt(dot(c, c)), dot(a, b)));
    ++out.directions;
    if (!in_group[of_file]) continue;
    ++out.signs;
    if (file.tangent[3][of_file] < 0.0f) ++out.mirrored;
    if (file.tangent[3][of_file] != made.tangent[3][of_made]) ++out.other_signs;
  }
  return out;
}

/// Each corner has a vertex for itself.
Mesh torn(const Mesh& mesh) {
  Mesh out;
  const auto tear = [&mesh](const FloatStream& from, FloatStream& to) {
    for (const uint32_t v : mesh.indices) to.push_back(from[v]);
  };
  for (size_t k = 0; k < 3; ++k) tear(mesh.position[k], out.position[k]), tear(mesh.normal[k], out.normal[k]);
  for (size_t k = 0; k < 2; ++k) tear(mesh.uv[k], out.uv[k]);
  for (size_t corner = 0; corner < mesh.indices.size(); ++corner) out.indices.push_back(uint32_t(corner));
  return out;
}

TEST_CASE("tangents that are made for a model are those that Blender gave it by MikkTSpace") {
  const Scene of_file = loaded(document()), made = loaded(without_tangents(document()));
  size_t directions = 0, signs = 0, mirrored = 0;
  for (size_t i = 0; i < of_file.meshes.size(); ++i) {
    REQUIRE(of_file.meshes[i].has_tangents());
    REQUIRE(made.meshes[i].has_tangents());
    const Difference found = difference(of_file.meshes[i], made.meshes[i]);
    CAPTURE(of_file.meshes[i].name, found.angle_rad, found.signs);
    CHECK(found.angle_rad < kSame_rad);
    CHECK(found.other_signs == 0);
    directions += found.directions, signs += found.signs, mirrored += found.mirrored;
  }
  CHECK(directions == 927);
  CHECK(signs == 899);
  CHECK(mirrored == 144);
}

TEST_CASE("Blender's tangents are made for its model, too, where no two corners share a vertex") {
  for (const Mesh& of_file : loaded(document()).meshes) {
    CAPTURE(of_file.name);
    Mesh made = torn(of_file);
    gltf::add_mikk_tangents(made.uv, made);
    const Difference found = difference(of_file, made);
    CHECK(found.angle_rad < kSame_rad);
    CHECK(found.other_signs == 0);
  }
}

TEST_CASE("tangents along v, and along texture coordinates of which one is slightly off, are not Blender's") {
  for (const Mesh& of_file : loaded(document()).meshes) {
    CAPTURE(of_file.name);
    Mesh along_v = of_file;
    gltf::add_mikk_tangents({of_file.uv[1], of_file.uv[0]}, along_v);
    const Difference swapped = difference(of_file, along_v);
    CHECK(swapped.angle_rad > 0.5);
    CHECK(swapped.other_signs == swapped.signs);
    Mesh off = of_file;
    UvStreams uv = of_file.uv;
    uv[1][of_file.indices[0]] += 1.0f / 256.0f;
    gltf::add_mikk_tangents(uv, off);
    CHECK(difference(of_file, off).angle_rad > 10.0 * kSame_rad);
  }
}

}  // namespace
}  // namespace trueshade
