#include "scenes/files/obj/creases.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <set>

#include "scenes/builtin/pcg32.h"
#include "scenes/files/obj/obj_scene.h"
#include "tests/scenes/expect_error.h"
#include "tests/scratch_folder.h"

// Normals of OBJ files that say nothing about them: smooth, with creases where planes meet at more than 60 degrees.
namespace trueshade {
namespace {

Scene creased_scene(std::string_view text, MissingNormals missing = MissingNormals::creased,
                    const SceneLimits& limits = {}) {
  const auto no_files = [](const std::string& name, uint64_t, const std::string&) -> Bytes {
    FAIL("asked for " + name);
    return {};
  };
  return scene_from_obj(Bytes(text.begin(), text.end()), "m.obj", limits, {}, missing, no_files);
}

Mesh creased_mesh(std::string_view text, MissingNormals missing = MissingNormals::creased) {
  Scene scene = creased_scene(text, missing);
  REQUIRE(scene.meshes.size() == 1);
  return std::move(scene.meshes[0]);
}

glm::vec3 position_of(const Mesh& mesh, size_t v) {
  return {mesh.position[0][v], mesh.position[1][v], mesh.position[2][v]};
}

glm::vec3 normal_of(const Mesh& mesh, size_t v) { return {mesh.normal[0][v], mesh.normal[1][v], mesh.normal[2][v]}; }

std::string vertex_text(double x, double y, double z) {
  char line[128];
  std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", x, y, z);
  return line;
}

std::string face_text(const std::vector<int>& corners) {
  std::string line = "f";
  for (const int corner : corners) line += ' ' + std::to_string(corner + 1);
  return line + '\n';
}

/// Of vertices whose x, then y, then z grows.
constexpr const char* kBoxFaces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// A box whose lower corner is (1, 2, 3), of a size, as six faces that look outwards.
std::string box_text(int size) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner)
    text += vertex_text(1 + size * (corner & 1), 2 + size * (corner >> 1 & 1), 3 + size * (corner >> 2));
  return text + kBoxFaces;
}

void check_is_box(const Mesh& mesh, const glm::vec3& middle) {
  CHECK(mesh.vertex_count() == 24);
  REQUIRE(mesh.triangle_count() == 12);
  for (size_t t = 0; t < 12; ++t) {
    const uint32_t* corner = &mesh.indices[3 * t];
    glm::vec3 face(0.0f);  // the axis along which all three corners lie on one side
    for (int k = 0; k < 3; ++k) {
      const float a = position_of(mesh, corner[0])[k] - middle[k], b = position_of(mesh, corner[1])[k] - middle[k],
                  c = position_of(mesh, corner[2])[k] - middle[k];
      if (a == b && b == c) face[k] = a > 0.0f ? 1.0f : -1.0f;
    }
    for (int k = 0; k < 3; ++k) CHECK(normal_of(mesh, corner[k]) == face);
  }
}

/// `segments` around and `rings` between the poles; triangles at the poles, and quads. With `pinched` poles each pole's
/// triangles are quads, two corners of which are the pole.
std::string sphere_text(int segments, int rings, bool pinched = false) {
  constexpr double kPi = 3.14159265358979323846;
  std::string text = vertex_text(0, 1, 0) + vertex_text(0, -1, 0);
  for (int ring = 1; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const double down = kPi * ring / rings, around = 2.0 * kPi * segment / segments;
      text += vertex_text(std::sin(down) * std::sin(around), std::cos(down), std::sin(down) * std::cos(around));
    }
  const auto at = [&](int ring, int segment) {
    return ring == 0 ? 0 : ring == rings ? 1 : 2 + (ring - 1) * segments + segment % segments;
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      std::vector<int> face = {at(ring, segment), at(ring + 1, segment), at(ring + 1, segment + 1),
                               at(ring, segment + 1)};
      if (!pinched && ring == 0) face.pop_back();
      if (!pinched && ring == rings - 1) face.erase(face.begin() + 2);
      text += face_text(face);
    }
  return text;
}

/// About the y axis, of radius 1, from y = -1 to 1, its caps two polygons.
std::string cylinder_text(int segments) {
  constexpr double kPi = 3.14159265358979323846;
  std::string text;
  for (int segment = 0; segment < segments; ++segment)
    for (const double y : {-1.0, 1.0})
      text += vertex_text(std::sin(2.0 * kPi * segment / segments), y, std::cos(2.0 * kPi * segment / segments));
  std::vector<int> top, bottom;
  for (int segment = 0; segment < segments; ++segment) {
    const int a = 2 * segment, b = 2 * ((segment + 1) % segments);
    text += face_text({a, b, b + 1, a + 1});
    top.push_back(a + 1);
    bottom.insert(bottom.begin(), a);
  }
  return text + face_text(top) + face_text(bottom);
}

TEST_CASE("creases: a cube has 24 vertices with the normals of its faces, alone and as a file") {
  for (const int size : {1, 7}) {
    const glm::vec3 middle = glm::vec3(1, 2, 3) + glm::vec3(0.5f * float(size));
    check_is_box(creased_mesh(box_text(size)), middle);
    const ScratchFolder folder;
    check_is_box(load_scene(folder.write("box.obj", box_text(size))).meshes[0], middle);
  }
}

TEST_CASE("creases: a sphere is the mesh that is smooth everywhere, also where quads are pinched at its poles") {
  for (const bool pinched : {false, true}) {
    const std::string text = sphere_text(48, 24, pinched);
    const Mesh ours = creased_mesh(text), smooth = creased_mesh(text, MissingNormals::smooth);
    CHECK(ours.vertex_count() == 2 + 48 * 23);
    CHECK((ours.indices == smooth.indices));
    for (size_t k = 0; k < 3; ++k) {
      CHECK((ours.position[k] == smooth.position[k]));
      CHECK((ours.normal[k] == smooth.normal[k]));
    }
  }
}

TEST_CASE("creases: a cylinder has a smooth side and flat caps with a hard rim") {
  for (const int segments : {7, 24, 360}) {
    CAPTURE(segments);
    const Mesh mesh = creased_mesh(cylinder_text(segments));
    CHECK(mesh.vertex_count() == 4 * size_t(segments));
    REQUIRE(mesh.triangle_count() == size_t(2 * segments + 2 * (segments - 2)));
    const double least = std::cos(3.14159265358979323846 / segments);  // a face's own normal at its edge
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
      const glm::vec3 at = position_of(mesh, mesh.indices[i]), n = normal_of(mesh, mesh.indices[i]);
      if (i < size_t(6 * segments)) {
        CHECK(std::fabs(n.y) < 1e-7f);
        CHECK(double(n.x) * double(at.x) + double(n.z) * double(at.z) > least - 1e-6);
      } else {
        CHECK(n == glm::vec3(0, at.y, 0));
      }
    }
  }
  CHECK(creased_mesh(cylinder_text(5)).vertex_count() == 5 * 4 + 2 * 5);  // five flat sides, which meet at 72 degrees
}

TEST_CASE("creases: planes at 60 degrees share normals, and at a little more they do not") {
  // The second triangle goes down by `fall` over a `run`: up to 60 degrees, fall^2 <= 3 run^2. Where `unit` is small,
  // the squares of areas vanish in double.
  for (const double unit : {0x1p-149, 1.0, 0x1p36}) {
    CAPTURE(unit);
    const auto vertices = [&](int run, int fall) {
      return creased_mesh("v 0 0 0\n" + vertex_text(unit, 0, 0) + vertex_text(0, unit, 0) +
                          vertex_text(0, -unit * run, -unit * fall) + "f 1 2 3\nf 2 1 4\n")
          .vertex_count();
    };
    CHECK(vertices(571, 989) == 4);          // 3 run^2 - fall^2 = 2
    CHECK(vertices(1542841, 2672279) == 4);  // 2
    CHECK(vertices(780, 1351) == 6);         // -1
    CHECK(vertices(2107560, 3650401) == 6);  // -1
    CHECK(vertices(1, 0) == 4);
    CHECK(vertices(0, 1) == 6);
    CHECK(vertices(-1, 1) == 6);  // over 90 degrees, where the square of the cosine is large again
    CHECK(vertices(-9, 1) == 6);
  }
  // Cross products (0, 1, 1) and (1 + e, -e, 1): the cosine is 1/2 at e = 0.
  const auto vertices_at = [](double e) {
    return creased_mesh("v 0 0 0\nv 1 1 -1\nv 1 0 0\n" + vertex_text(0, 1, e) + "f 1 3 2\nf 1 2 4\n").vertex_count();
  };
  CHECK(vertices_at(0.0) == 4);
  CHECK(vertices_at(-0x1p-23) == 4);
  CHECK(vertices_at(0x1p-23) == 6);
}

TEST_CASE("creases: a small box far away keeps its faces") {
  std::string text;
  for (int corner = 0; corner < 8; ++corner)
    text += vertex_text(1000001 + (corner & 1), 2 + (corner >> 1 & 1), 3 + (corner >> 2));
  check_is_box(creased_mesh(text + kBoxFaces), glm::vec3(1000001.5f, 2.5f, 3.5f));
}

TEST_CASE("creases: objects, materials and texture coordinates part vertices, and not normals") {
  const std::string faces[] = {"f 1 2 3 4\n", "f 2 5 6 3\n"};  // a bend of 45 degrees
  const std::string bend = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 -1\nv 2 1 -1\nvt 0 0\nvt 1 0\n";
  const auto shared = [](const Scene& scene, const glm::vec3& at) {
    std::set<std::array<float, 3>> normals;
    for (const Mesh& mesh : scene.meshes)
      for (size_t v = 0; v < mesh.vertex_count(); ++v)
        if (position_of(mesh, v) == at)
          normals.insert({normal_of(mesh, v).x, normal_of(mesh, v).y, normal_of(mesh, v).z});
    REQUIRE(normals.size() == 1);
    return *normals.begin();
  };
  const Scene whole = creased_scene(bend + faces[0] + faces[1]);
  CHECK(whole.meshes[0].vertex_count() == 6);
  const std::array<float, 3> expected = shared(whole, {1, 0, 0});
  CHECK(expected[0] > 0.0f);
  CHECK(expected[2] > 0.0f);
  const Scene objects = creased_scene(bend + faces[0] + "o b\n" + faces[1]),
              materials = creased_scene(bend + faces[0] + "usemtl b\n" + faces[1]);
  const Scene seam = creased_scene(bend + "f 1/1 2/1 3/1 4/1\nf 2/2 5/2 6/2 3/2\n");
  for (const Scene* scene : {&objects, &materials}) {
    REQUIRE(scene->meshes.size() == 2);
    CHECK(scene->meshes[0].vertex_count() == 4);
    CHECK(scene->meshes[1].vertex_count() == 4);
    CHECK((shared(*scene, {1, 0, 0}) == expected));
  }
  CHECK(seam.meshes[0].vertex_count() == 8);
  CHECK((shared(seam, {1, 0, 0}) == expected));
}

TEST_CASE("creases: groups or normals anywhere in a file, and other choices of the reader, leave it as it was") {
  const auto count = [](const std::string& text, MissingNormals missing = MissingNormals::creased) {
    return creased_mesh(text, missing).vertex_count();
  };
  CHECK(count(box_text(1)) == 24);
  CHECK(count("s 1\n" + box_text(1)) == 8);
  CHECK(count("s off\n" + box_text(1)) == 36);
  CHECK(count(box_text(1) + "s 1\nf 1 3 4\n") == 8);
  CHECK(count(box_text(1) + "vn 0 0 1\n") == 8);
  CHECK(count(box_text(1) + "vn 0 0 1\nf 1//1 3//1 4//1\n") == 8 + 3);
  CHECK(count(box_text(1), MissingNormals::smooth) == 8);
  CHECK(count(box_text(1), MissingNormals::flat) == 36);
  const ScratchFolder folder;
  folder.write("box.obj", box_text(1));
  const auto in_scene = [&](const std::string& more) {
    const std::string json = R"({"version": 1, "objects": [{"geometry": "box.obj")" + more + "}]}";
    return load_scene(folder.write("scene.json", json)).meshes[0].vertex_count();
  };
  CHECK(in_scene("") == 36);
  CHECK(in_scene(R"(, "normals": "smooth")") == 8);
}

TEST_CASE("creases: a corner of a triangle without an area is smooth, and the triangle changes no other corner") {
  const Mesh plain = creased_mesh(box_text(2));
  const Mesh mesh = creased_mesh(box_text(2) + "f 1 1 2\nf 8 8 8\n");
  CHECK(mesh.vertex_count() == 24 + 3);
  REQUIRE(mesh.triangle_count() == 14);
  for (size_t i = 0; i < 36; ++i) CHECK(normal_of(mesh, mesh.indices[i]) == normal_of(plain, plain.indices[i]));
  const Mesh smooth = creased_mesh(box_text(2), MissingNormals::smooth);
  const uint32_t last = mesh.indices[39];
  CHECK(position_of(mesh, last) == glm::vec3(3, 4, 5));
  CHECK(mesh.indices[40] == last);
  for (const uint32_t i : smooth.indices)
    if (position_of(smooth, i) == glm::vec3(3, 4, 5)) CHECK(normal_of(smooth, i) == normal_of(mesh, last));
  const Mesh point = creased_mesh("v 1 2 3\nf 1 1 1\n");
  CHECK(point.vertex_count() == 1);
  CHECK(normal_of(point, 0) == glm::vec3(0.0f));
}

/// The definition, for each corner over all triangles of the file.
struct CreaseOracle {
  using Vec = std::array<long double, 3>;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec> cross;

  CreaseOracle(const std::vector<std::array<float, 3>>& points, std::vector<std::array<int, 3>> of)
      : triangles(std::move(of)) {
    for (const auto& t : triangles) {
      Vec u, v;
      for (size_t k = 0; k < 3; ++k) {
        const long double a = points[size_t(t[0])][k];
        u[k] = points[size_t(t[1])][k] - a;
        v[k] = points[size_t(t[2])][k] - a;
      }
      cross.push_back({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]});
    }
  }

  static long double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  std::set<size_t> members(size_t triangle, int point) const {
    std::set<size_t> out;
    const Vec& own = cross[triangle];
    for (size_t t = 0; t < triangles.size(); ++t) {
      if (std::count(triangles[t].begin(), triangles[t].end(), point) == 0 || dot(cross[t], cross[t]) == 0) continue;
      const long double cosine = dot(own, cross[t]);
      const bool within = cosine > 0 && 4 * cosine * cosine >= dot(own, own) * dot(cross[t], cross[t]);
      if (within || dot(own, own) == 0) out.insert(t);
    }
    return out;
  }

  Vec normal(const std::set<size_t>& of) const {
    Vec sum{};
    for (const size_t t : of)
      for (size_t k = 0; k < 3; ++k) sum[k] += cross[t][k];
    const long double length = std::sqrt(dot(sum, sum));
    for (size_t k = 0; k < 3 && length > 0; ++k) sum[k] /= length;
    return sum;
  }
};

/// Half an ulp of float from 1/2 to 1, and what double rounds.
constexpr double kCreaseError = 0x1p-25 + 0x1p-40;

void check_creases(const std::vector<std::array<float, 3>>& points, const std::vector<std::array<int, 3>>& triangles) {
  std::string text;
  for (const auto& p : points) text += vertex_text(double(p[0]), double(p[1]), double(p[2]));
  for (const auto& t : triangles) text += face_text({t[0], t[1], t[2]});
  const Mesh mesh = creased_mesh(text);
  const CreaseOracle oracle(points, triangles);
  REQUIRE(mesh.triangle_count() == triangles.size());
  std::map<std::pair<int, std::set<size_t>>, uint32_t> vertex_of;
  double worst = 0.0;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    const int point = triangles[i / 3][i % 3];
    const uint32_t vertex = mesh.indices[i];
    for (int k = 0; k < 3; ++k) REQUIRE(position_of(mesh, vertex)[k] == points[size_t(point)][size_t(k)]);
    const std::set<size_t> members = oracle.members(i / 3, point);
    REQUIRE(vertex_of.try_emplace({point, members}, vertex).first->second == vertex);
    const CreaseOracle::Vec expected = oracle.normal(members);
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, double(std::fabs(normal_of(mesh, vertex)[k] - expected[size_t(k)])));
  }
  CHECK(worst <= kCreaseError);
  CHECK(vertex_of.size() == mesh.vertex_count());
}

TEST_CASE("creases: on random meshes every corner is as the definition has it") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Pcg32 random(seed, 5);
    // Small whole numbers make planes at exactly 60 and 90 degrees, and triangles without an area.
    const bool whole = seed % 2 == 0;
    const uint32_t count = 4 + random.below(30);
    std::vector<std::array<float, 3>> points(count);
    for (auto& p : points)
      for (float& x : p) x = whole ? float(random.below(4)) : float(20.0 * random.real() - 10.0);
    std::vector<std::array<int, 3>> triangles(1 + random.below(200));
    for (auto& t : triangles)
      for (int& corner : t) corner = int(random.below(count));
    check_creases(points, triangles);
  }
}

TEST_CASE("creases: on random hills every corner is as the definition has it") {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Pcg32 random(seed, 6);
    constexpr int kSide = 9;
    const double height = 0.1 + 0.2 * double(seed);
    std::vector<std::array<float, 3>> points;
    std::vector<std::array<int, 3>> triangles;
    for (int z = 0; z < kSide; ++z)
      for (int x = 0; x < kSide; ++x) {
        points.push_back({float(x), float(height * random.real()), float(z)});
        if (x + 1 == kSide || z + 1 == kSide) continue;
        const int a = z * kSide + x;
        triangles.push_back({a, a + kSide, a + 1});
        triangles.push_back({a + 1, a + kSide, a + kSide + 1});
      }
    check_creases(points, triangles);
  }
}

/// A pyramid of four steep sides, each a fan of `fan` triangles about the apex, which is the first vertex.
std::string pyramid_text(int fan) {
  std::string text = vertex_text(0, 4 * fan, 0);
  const int corners[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < fan; ++i)
      text += vertex_text(fan * corners[side][0] + i * (corners[side + 1][0] - corners[side][0]), 0,
                          fan * corners[side][1] + i * (corners[side + 1][1] - corners[side][1]));
  for (int i = 0; i < 4 * fan; ++i) text += face_text({0, 1 + i, 1 + (i + 1) % (4 * fan)});
  return text;
}

TEST_CASE("creases: a vertex of more triangles than kMostCreasedTriangles is smooth") {
  constexpr int kMost = int(obj::kMostCreasedTriangles);
  const auto at_apex = [](const Mesh& mesh) {
    return std::count(mesh.position[1].begin(), mesh.position[1].end(),
                      *std::max_element(mesh.position[1].begin(), mesh.position[1].end()));
  };
  const Mesh under = creased_mesh(pyramid_text(kMost / 4)), over = creased_mesh(pyramid_text(kMost / 4 + 1));
  CHECK(at_apex(under) == 4);
  CHECK(under.vertex_count() == size_t(4 + kMost + 4));  // four corners have two sides each
  CHECK(at_apex(over) == 1);
  CHECK(over.vertex_count() == size_t(1 + kMost + 4 + 4));
  CHECK(normal_of(over, over.indices[0]) == glm::vec3(0, 1, 0));
}

TEST_CASE("creases: time grows with the number of triangles, however many of them are around a vertex") {
  Pcg32 random(1, 7);
  std::string text;
  constexpr int kTriangles = 60000, kVertices = 3 * kTriangles / (int(obj::kMostCreasedTriangles) - 64);
  for (int i = 0; i < kVertices; ++i) text += vertex_text(random.real(), random.real(), random.real());
  for (int i = 0; i < kTriangles; ++i)
    text += face_text({int(random.below(kVertices)), int(random.below(kVertices)), int(random.below(kVertices))});
  std::string one = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < kTriangles; ++i) one += "f 1 2 3\n";
  const std::clock_t start = std::clock();  // of the CPU: other programs may be at work
  CHECK(creased_mesh(one).vertex_count() == 3);
  CHECK(creased_mesh(text).vertex_count() > size_t(kVertices));
  CHECK((std::clock() - start) / CLOCKS_PER_SEC < 10);
}

TEST_CASE("creases: what they take counts against the limit of the geometry") {
  const std::string text = sphere_text(48, 24);
  const auto taken = [&](MissingNormals missing) {
    uint64_t low = 0, high = uint64_t(1) << 24;
    while (low + 1 < high) {
      const uint64_t middle = (low + high) / 2;
      SceneLimits limits;
      limits.geometry_bytes = middle;
      bool fits = true;
      try {
        creased_scene(text, missing, limits);
      } catch (const Error& error) {
        REQUIRE(error.kind() == ErrorKind::limit);
        fits = false;
      }
      (fits ? high : low) = middle;
    }
    return high;
  };
  const uint64_t triangles = 2 * 48 * 23, positions = 2 + 48 * 23;
  // A triangle with its part and its polygon, two numbers a corner, and one a position; and the cross products and
  // numbers of the triangles at a pole.
  CHECK(taken(MissingNormals::creased) ==
        taken(MissingNormals::smooth) + triangles * (5 + 6) * 4 + (positions + 1) * 4 + 48 * (3 * 8 + 4));
  SceneLimits limits;  // the last vertex is the pole of the last ring, whose first face is line 1106 + 23 * 48 + 1
  limits.geometry_bytes = taken(MissingNormals::creased) - 1;
  CHECK_STARTS_WITH(error_of(ErrorKind::limit, [&] { creased_scene(text, MissingNormals::creased, limits); }),
                    "m.obj: line 2211: the geometry is over the limit (at most ");
  limits.geometry_bytes = 3 * sizeof(float);
  CHECK(error_of(ErrorKind::bad_input, [&] { creased_scene("v 1 2 3\n", MissingNormals::creased, limits); }) ==
        "m.obj: the file has no faces (f statements: nothing else is drawn)");
}

}  // namespace
}  // namespace trueshade
