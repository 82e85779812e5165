#include "scenes/builtin/builtin_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "expect_error.h"
#include "scenes/builtin/builtin.h"
#include "scenes/shapes.h"

namespace trueshade {
namespace {

/// Every edge runs once each way: the surface is closed and turned one way throughout.
bool is_closed(const Mesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges, turned;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    edges.emplace_back(a, b);
    turned.emplace_back(b, a);
  }
  std::sort(edges.begin(), edges.end());
  std::sort(turned.begin(), turned.end());
  return edges == turned && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

/// Six times the volume inside; positive where triangles are counter-clockwise seen from outside.
double volume6(const Mesh& mesh) {
  double sum = 0.0;
  const auto at = [&](size_t i) {
    const uint32_t v = mesh.indices[i];
    return glm::dvec3(mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]);
  };
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = at(i), b = at(i + 1), c = at(i + 2);
    sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  }
  return sum;
}

/// Triangles a cluster, cut from consecutive triangles at 64 vertices or 126 triangles.
double triangles_per_cluster(const Mesh& mesh) {
  size_t clusters = 1, triangles = 0;
  std::vector<uint32_t> vertices;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::vector<uint32_t> grown = vertices;
    for (size_t k = 0; k < 3; ++k)
      if (std::find(grown.begin(), grown.end(), mesh.indices[i + k]) == grown.end())
        grown.push_back(mesh.indices[i + k]);
    if (grown.size() > 64 || triangles == 126) {
      ++clusters;
      triangles = 0;
      grown.assign(mesh.indices.begin() + long(i), mesh.indices.begin() + long(i) + 3);
    }
    vertices = std::move(grown);
    ++triangles;
  }
  return double(mesh.triangle_count()) / double(clusters);
}

/// Normals within a right angle of their triangles' own.
bool normals_face_outwards(const Mesh& mesh) {
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::dvec3 p[3], n[3];
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.indices[i + k];
      p[k] = {mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]};
      n[k] = {mesh.normal[0][v], mesh.normal[1][v], mesh.normal[2][v]};
    }
    const glm::dvec3 a = p[1] - p[0], b = p[2] - p[0];
    const glm::dvec3 face(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    for (const glm::dvec3& normal : n)
      if ((face.x * normal.x + face.y * normal.y) + face.z * normal.z < 0.0) return false;
  }
  return true;
}

struct Expected {
  const char* name;
  size_t instances, lights;
  uint64_t triangles;
  const char* hash;
};

// The hashes were recorded from this code when the scenes were frozen; they hold for every compiler and processor.
constexpr Expected kExpected[] = {
    {"city", 2490, 757, 29880, "f5c2b6f8d589d958b3c39a8096a3f0825fc8a5ca26b023277bf14914b162bfac"},
    {"rabbits", 125, 100, 5000000, "443db05eea9330dc7a3c47fa5f6634893954683ba8665f2fcef62b804c3796cc"},
    {"sphere", 1, 100, 20000, "e66619562637bf35a17926237fc76e49f2eae382c9a427b4145e68b391ee353a"},
    {"red", 1, 100, 7992002, "de30d3fa3ac42dd5c290b8a5707a8d6416e114c7db5bfbe39981783e2cf55f28"},
    {"cornell", 7, 12, 1984, "d081a1414f1ab46cfba4f294e16fa4ae0c35b03ff1673eed6bcb8084b914c0ab"},
    {"circle", 26, 64, 80360, "b9e137ce60277f0fe4ec06ddac4372216ac381c86af66b2d8f41e1543984250e"},
    {"lecture", 13, 15, 95712, "f3b241f82252b72f9008ceea9f344025f0afe5acfb138a63ecdf6b0b0f3753a8"},
    {"atrium", 652, 256, 613940, "acf6d38294dfc5575b939e5f6a04c753af9c0e70db47046cbb38f41ea3cfd56b"},
};

TEST_CASE("each built-in scene has its numbers and its hash") {
  for (const Expected& expected : kExpected) {
    INFO(expected.name);
    const Scene scene = load_scene(std::string("builtin:") + expected.name);
    CHECK(scene.spec == std::string("builtin:") + expected.name);
    CHECK(scene.instances.size() == expected.instances);
    CHECK(scene.lights.size() == expected.lights);
    CHECK(scene.triangle_count() == expected.triangles);
    CHECK(scene_hash(scene) == expected.hash);
    for (const Mesh& mesh : scene.meshes) {
      INFO(mesh.name);
      CHECK(normals_face_outwards(mesh));
      if (mesh.vertex_count() < 100000 && mesh.vertex_count() > 1000) CHECK(triangles_per_cluster(mesh) > 75.0);
    }
  }
  CHECK(builtin_scenes().size() == std::size(kExpected));
}

TEST_CASE("red has 4 million vertices and ambient, point and spot lights") {
  const Scene scene = builtin_scene("red");
  CHECK(scene.meshes[0].vertex_count() == 4000000);
  std::map<LightType, int> count;
  for (const Light& light : scene.lights) ++count[light.type];
  CHECK(count[LightType::ambient] == 1);
  CHECK(count[LightType::spot] >= 20);
  CHECK(count[LightType::point] >= 20);
}

TEST_CASE("closed meshes are closed, of one piece's genus, and turned outwards") {
  const std::pair<Mesh, int> meshes[] = {
      {builtin::rabbit_mesh(), 2}, {sphere_mesh(50), 2}, {sphere_mesh(1), 2}, {builtin::knot_mesh(), 0}};
  for (const auto& [mesh, euler] : meshes) {
    INFO(mesh.name);
    CHECK(is_closed(mesh));
    const auto triangles = long(mesh.triangle_count());
    CHECK(long(mesh.vertex_count()) - triangles * 3 / 2 + triangles == euler);
    CHECK(volume6(mesh) > 0.0);
  }
  CHECK(meshes[0].first.triangle_count() == 40000);
  CHECK(volume6(cube_mesh()) == 6.0);
}

TEST_CASE("parameters change what they name") {
  CHECK(builtin_scene("city,lights=3,objects=10").lights.size() == 3);
  CHECK(builtin_scene("city,lights=3,objects=10").instances.size() == 10);
  CHECK(builtin_scene("city,lights=0").lights.empty());
  CHECK(scene_hash(builtin_scene("city,seed=1")) == scene_hash(builtin_scene("city")));
  CHECK(scene_hash(builtin_scene("city,seed=2")) != scene_hash(builtin_scene("city")));
  CHECK(builtin_scene("rabbits,objects=1").triangle_count() == 40000);
  CHECK(builtin_scene("circle,objects=1,lights=1").lights.size() == 1);
  CHECK(builtin_scene("cornell,lights=500").lights.size() == 500);
  CHECK(builtin_scene("sphere,lights=1").lights.size() == 1);
}

TEST_CASE("100,000 lights at constant overlap reach as many neighbours as 757") {
  const auto mean_reach2 = [](const Scene& scene) {
    double sum = 0.0;
    for (const Light& light : scene.lights) sum += double(light.range) * double(light.range);
    return sum;
  };
  const double usual = mean_reach2(builtin_scene("city"));
  const Scene many = builtin_scene("city,lights=100000");
  CHECK(many.lights.size() == 100000);
  CHECK(mean_reach2(many) == Approx(usual).epsilon(0.02));  // sum of areas
  CHECK(builtin_scene("city,lights=100000,radius=constant").lights[0].range == builtin_scene("city").lights[0].range);
}

TEST_CASE("every built-in scene takes any number of lights") {
  for (const BuiltinInfo& info : builtin_scenes()) {
    if (info.name == "red") continue;  // its rock takes seconds to make
    INFO(info.name);
    for (const size_t count : {0u, 1u, 2u, 757u, 100000u}) {
      Scene scene = builtin_scene(std::string(info.name) + ",lights=" + std::to_string(count) + ",seed=9");
      CHECK(scene.lights.size() == count);
      CHECK_NOTHROW(set_time(scene, 3.3));
    }
    CHECK(builtin_scene(std::string(info.name) + ",lights=1048576,radius=constant").lights.size() == 1048576);
  }
}

TEST_CASE("lights beyond a scene's own reach less far, unless their radius is constant") {
  for (const std::string name : {"lecture", "atrium"}) {
    const float usual = builtin_scene(name).lights.back().range;
    CHECK(builtin_scene(name + ",lights=10000,radius=constant").lights.back().range == usual);
    const double share = std::sqrt(double(builtin_scene(name).lights.size()) / 10000.0);
    CHECK(builtin_scene(name + ",lights=10000").lights.back().range == Approx(usual * share));
  }
}

TEST_CASE("lecture is a textured room under spot lights that sweep") {
  Scene scene = builtin_scene("lecture");
  CHECK(scene.textures.size() == 2);
  for (const Texture& texture : scene.textures) CHECK(texture.levels.size() > 8);
  CHECK(scene.meshes[0].has_uv());
  const std::vector<Light> before = scene.lights;
  set_time(scene, 1.5);
  CHECK(before[0].type == LightType::ambient);
  for (size_t i = 1; i < before.size(); ++i) {
    CHECK(before[i].type == LightType::spot);
    CHECK(scene.lights[i].position == before[i].position);
    CHECK(scene.lights[i].direction != before[i].direction);
  }
}

std::string builtin_refusal(const std::string& spec, ErrorKind kind = ErrorKind::bad_input) {
  return error_of(kind, [&] { builtin_scene(spec); });
}

TEST_CASE("bad specs are refused with what would be right") {
  CHECK_STARTS_WITH(builtin_refusal(""), "builtin:: no built-in scene has this name");
  CHECK_STARTS_WITH(builtin_refusal("City"),
                    "builtin:City: no built-in scene has this name (did you mean city? one of city rabbits");
  CHECK_STARTS_WITH(builtin_refusal("city,"), "builtin:city,: '' has no value");
  CHECK_STARTS_WITH(builtin_refusal("city,lights"), "builtin:city,lights: 'lights' has no value");
  for (const char* bad : {"city,lights=", "city,lights=-1", "city,lights=1.5", "city,lights= 1",
                          "city,lights=99999999999", "city,objects=0", "city,seed=18446744073709551616",
                          "city,radius=big", "city,color=red", "city,seed=1,seed=1", "sphere,objects=2"})
    builtin_refusal(bad);
  builtin_refusal("city,lights=1048577", ErrorKind::limit);
}

}  // namespace
}  // namespace trueshade
