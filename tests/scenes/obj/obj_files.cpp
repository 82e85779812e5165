#include <cmath>
#include <ctime>

#include "scenes/files/obj/obj_scene.h"
#include "tests/scenes/bytes_of.h"
#include "tests/scenes/expect_error.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// A scene of a text that names no files.
Scene read_obj(std::string_view text, MissingNormals missing = MissingNormals::flat, const SceneLimits& limits = {}) {
  const auto no_files = [](const std::string& name, uint64_t, const std::string&) -> Bytes {
    FAIL("asked for " + name);
    return {};
  };
  return scene_from_obj(bytes_of(text), "m.obj", limits, {}, missing, no_files);
}

std::string obj_refusal(std::string_view text, ErrorKind kind = ErrorKind::bad_input) {
  return error_of(kind, [&] { read_obj(text); });
}

constexpr std::string_view kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string square(std::string_view more) { return std::string(kSquare) + std::string(more); }

/// Positions of a mesh's corners, in the order of its triangles.
std::vector<glm::vec3> corners_of(const Mesh& mesh) {
  std::vector<glm::vec3> out;
  for (const uint32_t i : mesh.indices) out.emplace_back(mesh.position[0][i], mesh.position[1][i], mesh.position[2][i]);
  return out;
}

TEST_CASE("OBJ: the four forms of corners, and negative indices, name the same vertices") {
  const std::vector<glm::vec3> expected{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::string all = square("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n");
  for (const char* face : {"f 1 2 3 4", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/3/1 4/4/1",
                           "f -4 -3 -2 -1", "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1", "f 1/ 2/ 3/ 4/", "fo +1 2 -2 4"}) {
    CAPTURE(face);
    const Scene scene = read_obj(all + face, MissingNormals::smooth);
    REQUIRE(scene.meshes.size() == 1);
    const Mesh& mesh = scene.meshes[0];
    CHECK(corners_of(mesh) == expected);
    CHECK(mesh.vertex_count() == 4);
    for (const float z : mesh.normal[2]) CHECK(z == 1.0f);
    if (mesh.has_uv()) CHECK(mesh.uv[0] == std::vector<float>{0, 1, 1, 0});
    if (mesh.has_uv()) CHECK(mesh.uv[1] == std::vector<float>{0, 0, 1, 1});
  }
}

TEST_CASE("OBJ: comments, joined lines, line ends of three kinds, a byte order mark and tabs are fine") {
  const std::vector<glm::vec3> expected = corners_of(read_obj(square("f 1 2 3")).meshes[0]);
  for (const std::string& text :
       {square("# f 9 9 9\nf 1 \\\n2 \\\r\n 3 # a face\n"), std::string("\xef\xbb\xbf") + square("f 1 2 3"),
        std::string("v 0 0 0\r\nv\t1 0 0\r\n\r\n  v 1 1 0 \r\nv 0 1 0\r\nf 1\t2 3\r\n"),
        std::string("v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3\r"),
        std::string("f 1 2 3\n") + std::string(kSquare),  // vertices may stand below
        std::string("v 0.0e0 -0 +0\nv 1.0E+00 .0 0.\nv 1 1 1e-99\nv 0 1 0\ng a b\ns off\nlod 3\nf 1 2 3")})
    CHECK(corners_of(read_obj(text).meshes[0]) == expected);
}

TEST_CASE("OBJ: numbers are the floats nearest to their text") {
  const Scene scene =
      read_obj("v 0.1 16777217 -3.4e-5\nv 1e-46 8.5070592e17 1e-300\nv 0.30000001192092896 1 2\nf 1 2 3");
  CHECK(scene.meshes[0].position[0] == std::vector<float>{0.1f, 0.0f, 0.3f});
  CHECK(scene.meshes[0].position[1] == std::vector<float>{16777216.0f, 8.5070592e17f, 1.0f});
  CHECK(scene.meshes[0].position[2] == std::vector<float>{-3.4e-5f, 0.0f, 2.0f});
}

TEST_CASE("OBJ: vertices have colours, all or some of them, and a weight says nothing") {
  const Scene scene = read_obj("v 0 0 0 1 0.5 0\nv 1 0 0\nv 1 1 0 0 0 1 0.25\nv 0 1 0 7\nf 1 2 3 4");
  CHECK(scene.meshes[0].color[0] == std::vector<float>{1, 1, 0, 1, 0, 1});  // flat normals: no shared corners
  CHECK(scene.meshes[0].color[1] == std::vector<float>{0.5f, 1, 0, 0.5f, 0, 1});
  CHECK(scene.meshes[0].color[3] == std::vector<float>{1, 1, 0.25f, 1, 0.25f, 1});
  CHECK_FALSE(read_obj(square("f 1 2 3")).meshes[0].has_color());
}

TEST_CASE("OBJ: texture coordinates that only some faces have are 0 elsewhere") {
  const Mesh mesh = read_obj(square("vt 0.5 0.25 0\nvt 1\nf 1 2 3\nf 1/1 2/2 3/1")).meshes[0];
  CHECK(mesh.uv[0] == std::vector<float>{0, 0, 0, 0.5f, 1, 0.5f});
  CHECK(mesh.uv[1] == std::vector<float>{0, 0, 0, 0.25f, 0, 0.25f});
}

TEST_CASE("OBJ: smoothing groups say where normals are shared, and the reader's rule where the file does not") {
  // Two squares at a right angle along the x axis.
  const std::string roof = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 0 0 1\n";
  const std::string faces[] = {"f 1 2 3 4\n", "f 1 6 5 2\n"};
  const float half = float(std::sqrt(0.5));
  const auto normals = [&](const std::string& first, const std::string& second, MissingNormals missing) {
    const Mesh mesh = read_obj(roof + first + faces[0] + second + faces[1], missing).meshes[0];
    return std::pair(mesh.vertex_count(), glm::vec3(mesh.normal[0][0], mesh.normal[1][0], mesh.normal[2][0]));
  };
  CHECK(normals("", "", MissingNormals::smooth).first == 6);
  CHECK(normals("", "", MissingNormals::flat).first == 12);
  CHECK(normals("s 1\n", "", MissingNormals::flat).first == 6);
  CHECK(normals("s off\n", "", MissingNormals::smooth).first == 12);
  CHECK(normals("s 0\n", "", MissingNormals::smooth).second == glm::vec3(0, 0, 1));
  CHECK(normals("s 1\n", "s 2\n", MissingNormals::smooth).first == 8);
  CHECK(normals("s 1\n", "s 2\n", MissingNormals::smooth).second == glm::vec3(0, 0, 1));
  // Corner 1: twice the area of the two triangles of the first square, and of both of the second.
  const glm::vec3 shared = normals("s 1\n", "s 1\n", MissingNormals::flat).second;
  CHECK(shared.x == 0.0f);
  CHECK(shared.y == Approx(half));
  CHECK(shared.z == Approx(half));
}

TEST_CASE("OBJ: an instance for each object and material, in the order of their first faces") {
  const Scene scene =
      read_obj(square("o a\nusemtl red\nf 1 2 3\nusemtl blue paint #2\nf 1 3 4\no b\nf 2 3 4\no a\nusemtl "
                      "red\nf 2 3 1\nusemtl unused\n"));
  REQUIRE(scene.instances.size() == 3);
  CHECK(scene.meshes[0].name == "a");
  CHECK(scene.meshes[0].triangle_count() == 2);
  CHECK(scene.meshes[2].name == "b");
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].name == "red");
  CHECK(scene.materials[1].name == "blue paint #2");
  CHECK(scene.instances[2].material == 1);
  CHECK(scene.notes ==
        std::vector<std::string>{
            "2 materials are grey, because no library of the file (mtllib) defines them: red, blue paint #2"});
}

TEST_CASE("OBJ: what is no face is named in a note, and what shapes no face is passed over") {
  const Scene scene =
      read_obj(square("p 1\nl 1 2 3\nl 1 2\nsurf 0 1 0 1 1 2 3 4\ncstype bezier\ndeg 3\nvp 0.5\nend\nf 1 2 3"));
  CHECK(scene.notes == std::vector<std::string>{"1 statement of points (p) is not drawn, because only faces are drawn",
                                                "2 statements of lines (l) are not drawn, because only faces are drawn",
                                                "1 curve or surface is not drawn, because only faces are drawn"});
  for (const char* without : {"", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nl 1 2\n"})
    CHECK(obj_refusal(without) == "m.obj: the file has no faces (f statements: nothing else is drawn)");
}

TEST_CASE("OBJ: many vertices, groups or objects at one position take no time each by the others") {
  constexpr int kFaces = 100000;
  const auto faces = [](const char* before_each) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    for (int i = 1; i <= kFaces; ++i) {
      if (*before_each != '\0') text += before_each + std::to_string(i) + '\n';
      text += "f 1 2 3\n";
    }
    return text;
  };
  const std::clock_t start = std::clock();  // of the CPU: other programs may be at work
  CHECK(read_obj(faces("s "), MissingNormals::smooth).meshes[0].vertex_count() == 3 * kFaces);
  CHECK(read_obj(faces(""), MissingNormals::flat).meshes[0].vertex_count() == 3 * kFaces);
  CHECK(read_obj(faces(""), MissingNormals::smooth).meshes[0].vertex_count() == 3);
  CHECK(read_obj(faces("o "), MissingNormals::smooth).meshes.size() == kFaces);
  std::string coordinates = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 1; i <= kFaces; ++i) coordinates += "vt 0." + std::to_string(i) + " 0\nf 1/-1 2/-1 3/-1\n";
  CHECK(read_obj(coordinates, MissingNormals::smooth).meshes[0].vertex_count() == 3 * kFaces);
  CHECK((std::clock() - start) / CLOCKS_PER_SEC < 20);  // 80 s each where each vertex is held against all others
}

TEST_CASE("OBJ: what is wrong names its line") {
  CHECK(obj_refusal("v 1 2\n") == "m.obj: line 1: z is missing (a number)");
  CHECK(obj_refusal("\n\nv 1 2 x\n") == "m.obj: line 3: z is 'x' (a number from -1e18 to 1e18)");
  for (const char* number : {"nan", "inf", "-inf", "2e18", "1e99", "1e400", "0x10", "1,5", "--1", "+-1", "1.0.0", "1e"})
    CHECK_STARTS_WITH(obj_refusal("v 1 2 " + std::string(number)), "m.obj: line 1: z is '");
  CHECK(obj_refusal("v 1 2 3 4 5") == "m.obj: line 1: a vertex has 5 numbers (x y z, or x y z R G B)");
  CHECK_STARTS_WITH(obj_refusal("v 1 2 3 4 5 6 7 8"), "m.obj: line 1: '8' is one word too many for 'v'");
  CHECK_STARTS_WITH(obj_refusal("v 1 2 3 0 -1 0"), "m.obj: line 1: the vertex's colour is out of range");
  CHECK_STARTS_WITH(obj_refusal("v 1 2 3 0 1 0 2"), "m.obj: line 1: the vertex's colour is out of range");
  CHECK_STARTS_WITH(obj_refusal("vn 1 0"), "m.obj: line 1: z is missing");
  CHECK_STARTS_WITH(obj_refusal("vn 1 0 0 0"), "m.obj: line 1: '0' is one word too many");
  CHECK_STARTS_WITH(obj_refusal("vt"), "m.obj: line 1: u is missing");
  CHECK(obj_refusal(square("f 1 2 0")) ==
        "m.obj: line 5: the index of a vertex is 0 (indices from 1 on, or negative ones)");
  CHECK(obj_refusal(square("f 1 2 5\nf 1 2 3")) ==
        "m.obj: line 5: the index of a vertex is 5 (at most the 4 that the file has)");
  CHECK(obj_refusal(square("f 1 2 3\nf 1 2 -5")) ==
        "m.obj: line 6: the index of a vertex is -5 (at most the 4 that stand above)");
  CHECK_STARTS_WITH(obj_refusal(square("f 1/1 2/1 3/1")), "m.obj: line 5: the index of a texture coordinate is 1");
  CHECK_STARTS_WITH(obj_refusal(square("f 1//1 2//1 3//1")), "m.obj: line 5: the index of a normal is 1");
  CHECK_STARTS_WITH(obj_refusal(square("f 1 2 99999999999")), "m.obj: line 5: the index of a vertex is 99999999999");
  CHECK_STARTS_WITH(obj_refusal(square("f 1 2 3x")), "m.obj: line 5: the index of a vertex is '3x'");
  for (const char* corner : {"1/2/3/4", "/1", "1//1/", "//"})
    CHECK_STARTS_WITH(obj_refusal(square("vt 0 0\nvt 0 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf " + std::string(corner))),
                      "m.obj: line 10: the corner is '");
  CHECK_STARTS_WITH(obj_refusal(square("f 1 2")), "m.obj: line 5: a face has 2 corners");
  CHECK_STARTS_WITH(obj_refusal(square("vt 0 0\nf 1/1 2 3")),
                    "m.obj: line 6: the corners of a face are of different forms");
  CHECK_STARTS_WITH(obj_refusal("hello world"), "m.obj: line 1: 'hello' is no statement of an OBJ file");
  CHECK_STARTS_WITH(obj_refusal(std::string("\0\1\2", 3)), "m.obj: line 1: '");
  CHECK_STARTS_WITH(obj_refusal("s yes"), "m.obj: line 1: the smoothing group is 'yes'");
  CHECK_STARTS_WITH(obj_refusal("s -1"), "m.obj: line 1: the smoothing group is '-1'");
  CHECK_STARTS_WITH(obj_refusal("mtllib"), "m.obj: line 1: mtllib names no file");
}

TEST_CASE("OBJ: memory is refused before it is taken") {
  SceneLimits limits;
  limits.geometry_bytes = 300;
  const auto limit_error = [&](const std::string& text) {
    return error_of(ErrorKind::limit, [&] { read_obj(text, MissingNormals::flat, limits); });
  };
  std::string many = "v 0 0 0\n";
  for (int i = 0; i < 30; ++i) many += "v 1 0 0\n";
  CHECK(limit_error(many) ==
        "m.obj: line 26: the geometry is over the limit (at most 300 bytes, or a higher "
        "--max-geometry-memory)");
  CHECK_STARTS_WITH(limit_error(square("f 1 2 3 4\nf 1 2 3 4")), "m.obj: line 5: the geometry is over the limit (");
  std::string comb = "v 0 9 0\nv 0 0 0\n";
  std::string face = "f 1 2";
  for (int i = 0; i < 5000; ++i) {
    comb += "v " + std::to_string(i + 1) + ' ' + std::to_string(i % 2) + " 0\n";
    face += ' ' + std::to_string(i + 3);
  }
  CHECK_STARTS_WITH(obj_refusal(comb + face, ErrorKind::limit), "m.obj: line 5003: a concave face has 5002 corners");
}

TEST_CASE("OBJ: files load by their ending, in capitals too and packed, alone and as an object's geometry") {
  const ScratchFolder folder;
  const std::string text = square("usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
  const Scene scene = load_scene(folder.write("A.OBJ", text));
  CHECK(scene.meshes.size() == 3);  // with the ground
  CHECK(scene.lights_of_ours);
  folder.write("b/m.obj", text);
  const std::string json = R"({"version": 1, "objects": [{"geometry": "b/m.obj"},
    {"geometry": "b/m.obj", "color": [1, 0, 0], "position": [2, 0, 0]},
    {"geometry": "b/m.obj", "normals": "smooth"}]})";
  const Scene used = load_scene(folder.write("scene.json", json));
  CHECK(used.meshes.size() == 4);  // once with flat normals, once with smooth ones
  CHECK(used.instances.size() == 6);
  CHECK(used.meshes[0].vertex_count() == 3);
}

}  // namespace
}  // namespace trueshade
