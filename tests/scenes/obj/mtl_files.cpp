#include <atomic>
#include <map>
#include <stdexcept>

#include "scenes/files/obj/obj_scene.h"
#include "scenes/files/obj/read_mtl.h"
#include "tests/scenes/expect_error.h"

namespace trueshade {
namespace {

constexpr std::string_view kObjTriangle = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

/// Files by name; a picture is named by what it holds.
struct Files {
  std::map<std::string, std::string> files;
  std::string obj{kObjTriangle};
  SceneLimits limits{};
  ImageDecoder decode = decoded;

  Scene read() const {
    const auto file = [&](const std::string& name, uint64_t, const std::string& where) {
      const auto found = files.find(name);
      if (found == files.end()) throw Error(ErrorKind::io, where + ": " + name, "there is none", "one");
      return Bytes(found->second.begin(), found->second.end());
    };
    return scene_from_obj(Bytes(obj.begin(), obj.end()), "m.obj", limits, decode, MissingNormals::flat, file);
  }

  /// "WxH" and then a code for each texel's R, G, B, A, rows from the top. Called by many threads.
  static Image decoded(std::span<const uint8_t> content, const std::string&, uint64_t) {
    Image image(content[0] - '0', content[1] - '0', Format::rgba8);
    if (content.size() != 2 + image.texels.size()) throw std::logic_error("a picture of another size");
    std::copy(content.begin() + 2, content.end(), image.texels.begin());
    return image;
  }
};

Scene with_library(const std::string& mtl, std::map<std::string, std::string> pictures = {}) {
  pictures["a.mtl"] = mtl;
  return Files{pictures}.read();
}

Material material_of(const std::string& statements) { return with_library("newmtl m\n" + statements).materials.at(0); }

std::string mtl_refusal(const std::string& mtl) {
  return error_of(ErrorKind::bad_input, [&] { with_library(mtl); });
}

/// A picture of one column, a texel for each word of four codes, from the top.
std::string column(const std::vector<std::array<int, 4>>& texels) {
  std::string out{'1', char('0' + texels.size())};
  for (const auto& texel : texels)
    for (const int code : texel) out += char(code);
  return out;
}

std::array<int, 4> texel(const Scene& scene, const TextureSlot& slot, size_t index) {
  const Array<uint8_t>& bytes = scene.textures.at(size_t(slot.texture)).levels[0].bytes;
  return {bytes[4 * index], bytes[4 * index + 1], bytes[4 * index + 2], bytes[4 * index + 3]};
}

TEST_CASE("MTL: numbers of a material") {
  const Material m = material_of("Kd 0.5 0.25 1\nKs 0.1 0.2 0.3\nKe 3\nNs 96.6\nd 0.5\nillum 2\nPr 0.4\nPm 1\n");
  CHECK(m.base_color == glm::vec4(0.5f, 0.25f, 1.0f, 0.5f));
  CHECK(m.transparent);
  CHECK(m.specular_color == glm::vec3(0.1f, 0.2f, 0.3f));
  CHECK(m.emission == glm::vec3(3.0f));
  CHECK(m.shininess == 97.0f);
  CHECK(m.roughness == 0.4f);
  CHECK(m.metallic == 1.0f);
  const Material bare = material_of("");
  CHECK(bare.base_color == glm::vec4(0.8f, 0.8f, 0.8f, 1.0f));
  CHECK(bare.specular_color == glm::vec3(0.0f));
  CHECK(bare.shininess == 32.0f);
  CHECK_FALSE(bare.transparent);
  CHECK_FALSE(bare.unlit);
  CHECK(material_of("Ns 100000").shininess == 8192.0f);
  CHECK(material_of("illum 0").unlit);
  CHECK(material_of("Ks 1 1 1\nillum 1").specular_color == glm::vec3(0.0f));
  CHECK(material_of("KD 1 0 0").base_color == glm::vec4(1, 0, 0, 1));
}

TEST_CASE("MTL: d and Tr are each other's rest, and d wins") {
  CHECK(material_of("Tr 0.25").base_color.w == 0.75f);
  CHECK(material_of("Tr 1").base_color.w == 1.0f);  // as MeshLab writes what is opaque
  CHECK(!material_of("Tr 1").transparent);
  CHECK(material_of("d 1\nTr 1").base_color.w == 1.0f);
  CHECK(material_of("Tr 1\nd 1").base_color.w == 1.0f);
  CHECK(material_of("d -halo 0.5").base_color.w == 0.5f);
}

TEST_CASE("MTL: a picture's bottom row is at v = 0, its options place it, and names may hold blanks and backslashes") {
  const std::string picture = column({{10, 20, 30, 255}, {40, 50, 60, 255}});
  const Scene scene =
      with_library("newmtl m\nKd 1 1 1\nmap_Kd -s 2 3 1 -o 0.5 -clamp on -blendu off tex\\a picture 100%.png\n",
                   {{"tex/a picture 100%.png", picture}});
  const TextureSlot& slot = scene.materials[0].color_map;
  CHECK(texel(scene, slot, 0) == std::array{40, 50, 60, 255});
  CHECK(scene.textures[0].format == TextureFormat::srgb8_a8);
  CHECK(scene.textures[0].levels.size() == 2);
  CHECK(slot.uv_set == 0);
  CHECK(slot.sampler.wrap[0] == Wrap::clamp_to_edge);
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0] == "What the material library says by these words is not drawn: -blendu (1)");
}

TEST_CASE("MTL: a picture is read once for all that read it alike") {
  const Scene scene = with_library("newmtl m\nmap_Kd a.png\nmap_Ks ./a.png\nmap_Ke a.png\n",
                                   {{"a.png", column({{1, 2, 3, 4}})}, {"./a.png", column({{1, 2, 3, 4}})}});
  CHECK(scene.textures.size() == 2);  // one for each spelling
  const Material& m = scene.materials[0];
  CHECK(m.color_map.texture == m.emission_map.texture);
  CHECK(m.base_color == glm::vec4(1.0f));
  CHECK(m.specular_color == glm::vec3(1.0f));
  CHECK(m.emission == glm::vec3(1.0f));
}

/// An OBJ whose triangles have `count` materials, and the MTL of these, in which each material names another picture.
Files with_pictures(int count) {
  Files files;
  files.obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < count; ++i) {
    const std::string name = std::to_string(i);
    files.obj += "usemtl " + name + "\nf 1 2 3\n";
    files.files["a.mtl"] += "newmtl " + name + "\nmap_Kd " + name + ".png\nmap_d " + name + ".png\n";
    files.files[name + ".png"] = column({{i, 20, 30, 255}, {i, 50, 60, 0}});
  }
  return files;
}

TEST_CASE("MTL: pictures are decoded by all cores, once each, in the order of their use") {
  Files files = with_pictures(40);
  std::atomic<int> decoded = 0;
  files.decode = [&](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
    ++decoded;
    return Files::decoded(content, where, most);
  };
  const Scene scene = files.read();
  CHECK(decoded == 40);
  REQUIRE(scene.textures.size() == 40);
  for (size_t i = 0; i < 40; ++i) {
    CHECK(scene.textures[i].name == std::to_string(i) + ".png");
    CHECK(scene.materials[i].color_map.texture == int32_t(i));
    CHECK(scene.textures[i].levels.size() == 2);
    CHECK(texel(scene, scene.materials[i].color_map, 0) == std::array{int(i), 50, 60, 0});
  }
}

TEST_CASE("MTL: of pictures that cannot be decoded the first in use is named") {
  for (const int first : {0, 3, 7, 8, 21}) {
    Files files = with_pictures(24);
    for (const int broken : {first, first + 1, 23})
      if (broken % 2 == 0)
        files.files.erase(std::to_string(broken) + ".png");
      else
        files.files[std::to_string(broken) + ".png"] = "broken";
    files.decode = [](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
      if (content[0] == 'b') throw Error(ErrorKind::bad_input, where, "it is broken", "a whole one");
      return Files::decoded(content, where, most);
    };
    const std::string name = std::to_string(first) + ".png", line = std::to_string(3 * first + 3);
    CHECK(error_of(first % 2 == 0 ? ErrorKind::io : ErrorKind::bad_input, [&] { files.read(); }) ==
          "a.mtl: line " + line + ": " + name +
              (first % 2 == 0 ? ": there is none (one)" : ": it is broken (a whole one)"));
  }
}

TEST_CASE("MTL: a polygon that is refused is named before pictures that are") {
  Files files = with_pictures(12);
  files.files["0.png"] = "broken";
  files.decode = [](std::span<const uint8_t>, const std::string& where, uint64_t) -> Image {
    throw Error(ErrorKind::bad_input, where, "it is broken", "a whole one");
  };
  CHECK_THAT(error_of(ErrorKind::bad_input, [&] { files.read(); }), Catch::Contains("0.png: it is broken"));
  files.limits.geometry_bytes = 1;
  CHECK_THAT(error_of(ErrorKind::limit, [&] { files.read(); }), Catch::Contains("geometry"));
}

TEST_CASE("MTL: pictures and their smaller levels are held to the limit, narrow ones too") {
  // A column of 2 texels has 8 bytes, and its level of 1 another 4: half as many again, where a square has a third.
  Files files = with_pictures(4);
  files.limits.texture_bytes = 48;
  CHECK(files.read().textures.size() == 4);
  files.limits.texture_bytes = 47;
  const std::string message = error_of(ErrorKind::limit, [&] { files.read(); });
  CHECK_STARTS_WITH(message,
                    "a.mtl: line 12: 3.png: with this picture and its smaller levels the pictures are over the limit");
  CHECK_THAT(message, Catch::Contains("--max-texture-memory"));
}

TEST_CASE("MTL: map_d gives the colours their alpha, and masks") {
  const std::string color = column({{10, 20, 30, 255}, {40, 50, 60, 255}}), grey = column({{200, 200, 200, 255}});
  const Scene by_red = with_library("newmtl m\nmap_Kd c.png\nmap_d d.png\n", {{"c.png", color}, {"d.png", grey}});
  const Material& m = by_red.materials[0];
  CHECK(texel(by_red, m.color_map, 0) == std::array{40, 50, 60, 200});
  CHECK(texel(by_red, m.color_map, 1) == std::array{10, 20, 30, 200});
  CHECK(m.alpha_cutoff == 0.5f);
  CHECK_FALSE(m.transparent);
  const std::string own = column({{10, 20, 30, 0}, {40, 50, 60, 255}});
  const Scene by_alpha = with_library("newmtl m\nmap_Kd c.png\nmap_d c.png\n", {{"c.png", own}});
  CHECK(texel(by_alpha, by_alpha.materials[0].color_map, 1) == std::array{10, 20, 30, 0});
  const Scene alone = with_library("newmtl m\nd 0.5\nmap_d d.png\n", {{"d.png", grey}});
  CHECK(texel(alone, alone.materials[0].color_map, 0) == std::array{255, 255, 255, 200});
  CHECK(alone.materials[0].transparent);
  CHECK(alone.materials[0].alpha_cutoff == 0.0f);
}

TEST_CASE("MTL: bump is a map of normals where it has colours, and of heights where it is grey") {
  const std::string normals = column({{128, 128, 255, 255}});
  const Scene bent = with_library("newmtl m\nmap_Bump -bm 0.5 n.png\n", {{"n.png", normals}});
  CHECK(texel(bent, bent.materials[0].normal_map, 0) == std::array{128, 128, 255, 255});
  CHECK(bent.materials[0].normal_scale == 0.5f);
  CHECK(bent.textures[0].format == TextureFormat::rgba8);
  // Heights from the bottom: 0, 255, 0, 0. At the second from the bottom dy = h(2) - h(0) = 0, at the third -1 * bm.
  const std::string heights = column({{0, 0, 0, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}, {0, 0, 0, 255}});
  const Scene raised = with_library("newmtl m\nbump -bm 1 h.png\n", {{"h.png", heights}});
  const TextureSlot& slot = raised.materials[0].normal_map;
  CHECK(texel(raised, slot, 1) == std::array{128, 128, 255, 255});
  const int up = int(std::nearbyint(255.0 * (0.5 + 0.5 * std::sqrt(0.5))));
  CHECK(texel(raised, slot, 2) == std::array{128, up, up, 255});
  CHECK(texel(raised, slot, 0) == std::array{128, 255 - up, up, 255});
  CHECK(raised.materials[0].normal_scale == 1.0f);
  const Scene stated = with_library("newmtl m\nnorm h.png\n", {{"h.png", heights}});
  CHECK(texel(stated, stated.materials[0].normal_map, 2) == std::array{0, 0, 0, 255});
}

TEST_CASE("MTL: roughness and metalness of two pictures are one texture's green and blue") {
  const std::string rough = column({{10, 0, 0, 255}, {20, 0, 0, 255}}), metal = column({{7, 0, 0, 255}});
  const Scene scene =
      with_library("newmtl m\nPr 0.5\nmap_Pr r.png\nmap_Pm m.png\n", {{"r.png", rough}, {"m.png", metal}});
  const Material& m = scene.materials[0];
  CHECK(texel(scene, m.metallic_roughness_map, 0) == std::array{255, 20, 7, 255});
  CHECK(texel(scene, m.metallic_roughness_map, 1) == std::array{255, 10, 7, 255});
  CHECK(m.roughness == 0.5f);
  CHECK(m.metallic == 1.0f);
}

TEST_CASE("MTL: libraries: several on a line, with blanks in their names, in folders of their own") {
  Files files{{{"one.mtl", "newmtl a\nKd 1 0 0\n"},
               {"my two.MTL", "newmtl b\nKd 0 1 0\n"},
               {"sub/three.mtl", "newmtl c\nmap_Kd ../top.png\n"},
               {"sub/../top.png", column({{9, 9, 9, 255}})}}};
  files.obj =
      "mtllib one.mtl my two.MTL\nmtllib sub\\three.mtl one.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\nusemtl "
      "c\nf 1 2 3\n";
  const Scene scene = files.read();
  REQUIRE(scene.materials.size() == 2);  // those that are drawn
  CHECK(scene.materials[0].base_color == glm::vec4(0, 1, 0, 1));
  CHECK(scene.textures.size() == 1);
  files.files["my two.MTL"] = "newmtl a\n";
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { files.read(); }),
                    "my two.MTL: line 1: a material of this name exists in another library");
}

TEST_CASE("MTL: what is not drawn is named in a note") {
  const Scene scene =
      with_library("newmtl m\nKa 1 1 1\nNi 1.5\nTf 1 1 1\nillum 7\nmap_Ka nowhere.png\nPcr 0.1\nvendor_word 3\n");
  CHECK(scene.notes ==
        std::vector<std::string>{
            "What the material library says by these words is not drawn: Pcr (1), map_Ka (1), "
            "vendor_word (1)",
            "1 material asks for reflection or refraction (illum 3 to 9), which is not drawn: Their highlights are"});
}

TEST_CASE("MTL: what is wrong names its line") {
  CHECK_STARTS_WITH(mtl_refusal("Kd 1 1 1"), "a.mtl: line 1: 'Kd' stands before the first newmtl");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nnewmtl m"), "a.mtl: line 2: a material of this name exists");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nKd 1 -1 1"), "a.mtl: line 2: a colour is out of range");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nKd 1 1"), "a.mtl: line 2: a colour is missing");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nKd 1 1 1 1"), "a.mtl: line 2: '1' is one word too many");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nKd spectral a.rfl 1"),
                    "a.mtl: line 2: colours by 'spectral' are not implemented");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nd 1.5"), "a.mtl: line 2: d is out of range");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nNs -1"), "a.mtl: line 2: Ns is out of range");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nPr nan"), "a.mtl: line 2: Pr is 'nan'");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nmap_Kd"), "a.mtl: line 2: the statement names no picture");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nmap_Kd -size 3 a.png"), "a.mtl: line 2: '-size' is no option of a picture");
  CHECK_STARTS_WITH(mtl_refusal("newmtl m\nmap_Kd -o 1e7 a.png"), "a.mtl: line 2: an option's number is out of range");
}

TEST_CASE("MTL: names of files stay below the OBJ file's folder") {
  for (const char* name :
       {"/etc/passwd", "C:\\a.png", "http://host/a.png", "..\\a.png", "a/../../b.png", "\\a.png", "sub/..\\..\\a.png"})
    CHECK_STARTS_WITH(mtl_refusal("newmtl m\nmap_Kd " + std::string(name)), "a.mtl: line 2: the path ");
  Files files;
  for (const char* name : {"/a.mtl", "../a.mtl", "file:a.mtl"}) {
    files.obj = "mtllib " + std::string(name) + "\n";
    CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { files.read(); }), "m.obj: line 1: the path ");
  }
  CHECK_STARTS_WITH(error_of(ErrorKind::io, [] { with_library("newmtl m\nmap_Kd none.png"); }),
                    "a.mtl: line 2: none.png: there is none");
}

}  // namespace
}  // namespace trueshade
