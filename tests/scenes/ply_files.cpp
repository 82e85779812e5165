#include <bit>
#include <cstring>

#include "bytes_of.h"
#include "expect_error.h"
#include "scenes/files/load_geometry.h"
#include "scenes/scene.h"
#include "tests/gzipped.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr std::string_view kQuad =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

Mesh read_ply(std::string_view text, MissingNormals normals = MissingNormals::flat) {
  Faults faults(Leniency::refused);
  return mesh_from_ply(bytes_of(text), "m.ply", normals, faults);
}

Mesh unpacked_ply(const Bytes& packed, uint64_t most_bytes) {
  Faults faults(Leniency::refused);
  return mesh_from_file(packed, "m.ply.gz", SceneLimits{.file_bytes = most_bytes}, MissingNormals::flat, faults);
}

std::string ply_refusal(std::string_view text) {
  return error_of(ErrorKind::bad_input, [&] { read_ply(text); });
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  result.replace(result.find(from), from.size(), to);
  return result;
}

template <typename T>
void append(std::string& out, T value, bool big_endian) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (big_endian) std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

/// The square with normals, colours, uv, an unknown element and unknown properties.
std::string binary_quad(bool big_endian) {
  std::string out =
      std::string("ply\r\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\r\nelement camera 2\r\nproperty list uchar double of\r\nelement vertex 4\r\n"
      "property double x\r\nproperty float y\r\nproperty short z\r\nproperty float quality\r\n"
      "property float nx\r\nproperty float ny\r\nproperty float nz\r\nproperty uchar red\r\n"
      "property uchar green\r\nproperty uchar blue\r\nproperty float s\r\nproperty float t\r\nelement face 2\r\n"
      "property int part\r\nproperty list uint ushort vertex_index\r\nend_header\r\n";
  for (const int count : {0, 2}) {
    append(out, uint8_t(count), big_endian);
    for (int i = 0; i < count; ++i) append(out, 1.5, big_endian);
  }
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    append(out, double(x), big_endian);
    append(out, float(y), big_endian);
    append(out, int16_t(-2), big_endian);
    for (const float v : {9.0f, 0.0f, 0.0f, 1.0f}) append(out, v, big_endian);
    for (const int v : {255, 0, 51}) append(out, uint8_t(v), big_endian);
    for (const int v : {x, y}) append(out, float(v), big_endian);
  }
  for (const int third : {2, 3}) {
    append(out, int32_t(7), big_endian);
    append(out, uint32_t(3), big_endian);
    for (const int v : {0, third - 1, third}) append(out, uint16_t(v), big_endian);
  }
  return out;
}

TEST_CASE("a text file's square becomes a fan of two triangles with flat normals") {
  const Mesh mesh = read_ply(kQuad);
  CHECK(mesh.triangle_count() == 2);
  CHECK(mesh.vertex_count() == 6);
  CHECK(mesh.position[0] == std::vector<float>{0, 1, 1, 0, 1, 0});
  CHECK(mesh.position[1] == std::vector<float>{0, 0, 1, 0, 1, 1});
  CHECK(mesh.normal[2] == std::vector<float>(6, 1.0f));
  CHECK_FALSE(mesh.has_color());
}

TEST_CASE("smooth normals keep the vertices and weigh triangles by area") {
  const Mesh square = read_ply(kQuad, MissingNormals::smooth);
  CHECK(square.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  CHECK(square.normal[2] == std::vector<float>(4, 1.0f));
  // A large triangle facing +z and a small one facing +x meet in vertices 0 and 1.
  const Mesh bent = read_ply(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n0 1 0\n-3 0 0\n0 0 -1\n3 0 1 2\n3 0 3 1\n",
      MissingNormals::smooth);
  CHECK(bent.normal[2][0] == Approx(3.0 / std::sqrt(10.0)));
  CHECK(bent.normal[0][0] == Approx(1.0 / std::sqrt(10.0)));
  CHECK(bent.normal[2][2] == 1.0f);
  CHECK(bent.normal[0][3] == 1.0f);
}

TEST_CASE("binary files of both byte orders read alike, unknown elements and properties skipped") {
  for (const bool big_endian : {false, true}) {
    const Mesh mesh = read_ply(binary_quad(big_endian));
    CHECK(mesh.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
    CHECK(mesh.position[0] == std::vector<float>{0, 1, 1, 0});
    CHECK(mesh.position[2] == std::vector<float>(4, -2.0f));
    CHECK(mesh.normal[2] == std::vector<float>(4, 1.0f));
    CHECK(mesh.color[0] == std::vector<float>(4, 1.0f));
    CHECK(mesh.color[2] == std::vector<float>(4, float(51.0 / 255.0)));
    CHECK(mesh.color[3] == std::vector<float>(4, 1.0f));
    CHECK(mesh.uv[1] == std::vector<float>{0, 0, 1, 1});
  }
}

TEST_CASE("a file cut at any byte is refused") {
  const std::string text(kQuad);
  for (size_t size = 0; size + 1 < text.size(); ++size) {  // without the last line end it is whole
    INFO(size);
    CHECK_STARTS_WITH(ply_refusal(text.substr(0, size)), "m.ply: line ");
  }
  CHECK_NOTHROW(read_ply(text.substr(0, text.size() - 1)));
  for (const bool big_endian : {false, true}) {
    const std::string binary = binary_quad(big_endian);
    for (size_t size = 0; size < binary.size(); ++size) ply_refusal(binary.substr(0, size));
    CHECK_STARTS_WITH(ply_refusal(binary.substr(0, binary.size() - 1)), "m.ply: byte ");
    CHECK_STARTS_WITH(ply_refusal(binary + "x"), "m.ply: byte ");
  }
  const std::string packed = gzipped(kQuad);
  for (size_t size = 0; size < packed.size(); ++size)
    error_of(ErrorKind::bad_input, [&] { unpacked_ply(bytes_of(packed.substr(0, size)), 1 << 20); });
}

TEST_CASE("bad text files are refused with the line") {
  CHECK_STARTS_WITH(ply_refusal("solid\n"), "m.ply: line 1: the file does not start with 'ply'");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "ascii", "ascii2")), "m.ply: line 2: the format is unknown");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "comment", "remark")), "m.ply: line 3: 'remark' is no keyword");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "vertex 4", "vertex -4")),
                    "m.ply: line 4: the count is no whole number");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "vertex 4", "vertex 4000000000")),
                    "m.ply: line 11: element vertex says 4000000000");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "vertex 4", "vertex 18446744073709551615")),
                    "m.ply: line 11: element vertex says");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "float y", "float x")), "m.ply: line 6: property x is given twice");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "float y", "float w")),
                    "m.ply: line 11: the vertices have only some of x to z");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "float y", "quad y")), "m.ply: line 6: 'quad' is no type");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "list uchar int", "list float int")),
                    "m.ply: line 9: the length of a list is a float");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "vertex_indices", "corners")),
                    "m.ply: line 14: the faces have no list");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "1 1 0", "1 nan 0")), "m.ply: line 13: vertex 2: y is out of range");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "1 1 0", "1 inf 0")), "m.ply: line 13: vertex 2: y is out of range");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "1 1 0", "1 2e18 0")), "m.ply: line 13: vertex 2: y is out of range");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "1 1 0", "1 0x1 0")), "m.ply: line 13: '0x1' is no number");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "1 1 0", "1 1,5 0")), "m.ply: line 13: '1,5' is no number");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "4 0 1 2 3", "4 0 1 2 4")),
                    "m.ply: line 15: face 0: index 4 is beyond the vertices (from 0 to below 4)");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "4 0 1 2 3", "4 0 1 2 -1")), "m.ply: line 15: face 0: index -1");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "4 0 1 2 3", "2 0 1")), "m.ply: line 15: face 0 has 2 corners");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "4 0 1 2 3", "200 0 1 2 3")), "m.ply: line 15: a list says 200");
  CHECK_STARTS_WITH(ply_refusal(replaced(kQuad, "4 0 1 2 3", "300 0 1 2 3")),
                    "m.ply: line 15: '300' does not fit its type");
  CHECK_STARTS_WITH(ply_refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                "property float z\nend_header\n0 0 0\n"),
                    "m.ply: line 8: there are no faces: this is a cloud of points");
  CHECK_STARTS_WITH(ply_refusal(std::string(kQuad) + "7\n"), "m.ply: line 16: more data after the last element");
  CHECK_STARTS_WITH(ply_refusal(std::string("ply\n") + std::string(100000, 'x')),
                    "m.ply: line 2: the header has no end");
}

TEST_CASE("where the header counts too many or too few vertices, the first face that cannot be read says so") {
  const auto with_count = [](const char* count) {
    return ply_refusal(replaced(kQuad, "element vertex 4", std::string("element vertex ") + count));
  };
  CHECK_STARTS_WITH(with_count("3"), "m.ply: line 14: face 0 has 0 corners; perhaps the vertices are not 3, as the");
  CHECK_STARTS_WITH(with_count("5"), "m.ply: line 15: face 0 has 2 corners; perhaps the vertices are not 5, as the");
  CHECK_STARTS_WITH(ply_refusal(replaced(replaced(kQuad, "face 1", "face 2"), "4 0 1 2 3", "3 0 1 2\n2 0 1")),
                    "m.ply: line 16: face 1 has 2 corners (");
}

TEST_CASE("a header of too many elements or properties is refused before names are compared for hours") {
  const auto header = [](int elements, int properties) {
    std::string text = "ply\nformat ascii 1.0\n";
    for (int e = 0; e < elements; ++e) {
      text += "element e" + std::to_string(e) + " 0\n";
      for (int p = 0; p < properties; ++p) text += "property char p" + std::to_string(p) + "\n";
    }
    return text + "end_header\n";
  };
  CHECK_STARTS_WITH(error_of(ErrorKind::limit, [&] { read_ply(header(200000, 0)); }),
                    "m.ply: line 259: there are too many elements");
  CHECK_STARTS_WITH(error_of(ErrorKind::limit, [&] { read_ply(header(1, 200000)); }),
                    "m.ply: line 260: there are too many properties");
}

TEST_CASE("text may use tabs, CRLF, plus signs and one line for all") {
  const Mesh mesh = read_ply(replaced(kQuad, "1 0 0\n1 1 0\n", "+1\t0 0 1 1.0e0 0\r\n"));
  CHECK(mesh.position[0] == std::vector<float>{0, 1, 1, 0, 1, 0});
}

TEST_CASE("a compressed file is unpacked, up to the limit and not beyond") {
  const Bytes packed = bytes_of(gzipped(kQuad));
  CHECK(unpacked_ply(packed, kQuad.size()).triangle_count() == 2);
  error_of(ErrorKind::limit, [&] { unpacked_ply(packed, kQuad.size() - 1); });
  const Bytes bomb = bytes_of(gzipped(std::string(32 << 20, ' ')));
  CHECK(bomb.size() < 40000);
  error_of(ErrorKind::limit, [&] { gunzipped(bomb, SceneLimits{.file_bytes = 1 << 20}, "bomb.ply.gz"); });
  error_of(ErrorKind::bad_input,
           [&] { gunzipped(bytes_of("no gzip at all"), SceneLimits{.file_bytes = 1 << 20}, "x.gz"); });
  const std::string two = gzipped("ab") + gzipped("cd");
  CHECK(gunzipped(bytes_of(two), SceneLimits{.file_bytes = 100}, "two.gz") == bytes_of("abcd"));
}

TEST_CASE("Stanford's dragon loads as its README says") {
  const char* given = std::getenv("TRUESHADE_ASSETS");
  const std::string folder = given ? given : TRUESHADE_SOURCE_DIR "/../shared/assets";
  const std::string path = folder + "/stanford/dragon_vrip_res4.ply.gz";
  if (!std::filesystem::exists(path)) {
    WARN("SKIPPED: " << path << " is absent; TRUESHADE_ASSETS names the folder of assets");
    return;
  }
  for (const auto& [name, triangles] : {std::pair("res4", 11102u), {"res3", 47794u}, {"res2", 202520u}}) {
    const Scene scene = load_scene(folder + "/stanford/dragon_vrip_" + name + ".ply.gz");
    CHECK(scene.meshes[0].triangle_count() == triangles);
    CHECK(scene.spec == std::string("dragon_vrip_") + name + ".ply.gz");
    CHECK(scene.lights.size() == 4);
  }
}

}  // namespace
}  // namespace trueshade
