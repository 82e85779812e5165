// --lenient: faults that harm the looks of a file alone are errors, unless the user asks to see the file all the same.
// --trust-paths: a file may name others anywhere.
#include <glm/vec3.hpp>

#include "expect_error.h"
#include "gltf/asset.h"
#include "scenes/files/content/scene_files.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

SceneLimits limits_with(Leniency leniency) {
  SceneLimits limits;
  limits.leniency = leniency;
  return limits;
}

constexpr const char* kHint = "; add --lenient to look at it all the same)";

/// Checks that a document is refused without leniency, that the hint is there where it is offered, and loads it.
Scene passed(const std::string& content, ErrorKind kind = ErrorKind::bad_input) {
  const std::string strict = gltf_refusal(content, kind);
  CHECK(strict.find("--lenient") == std::string::npos);
  CHECK(gltf_refusal(content, kind, limits_with(Leniency::offered)) == strict.substr(0, strict.size() - 1) + kHint);
  return load_gltf(content, limits_with(Leniency::asked));
}

std::string the_fault(const Scene& scene) {
  CHECK(scene.passed_over.size() == 1);
  const std::string line = scene.passed_over.empty() ? "" : scene.passed_over.front();
  CHECK(std::find(scene.notes.begin(), scene.notes.end(),
                  "As --lenient asks, which makes this no reference: " + line) != scene.notes.end());
  return line;
}

/// A triangle with a material, whose JSON this is, and further lists.
std::string triangle_of_material(const std::string& material, const std::string& more) {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  return asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0)", "",
                                  R"("materials": [{)" + material + "}]" + (more.empty() ? "" : ", " + more)));
}

TEST_CASE("lenient: a file without faults is the same scene, and says nothing") {
  const std::string content = triangle_of_material("", "");
  const Scene strict = load_gltf(content), lenient = load_gltf(content, limits_with(Leniency::asked));
  CHECK(scene_hash(lenient) == scene_hash(strict));
  CHECK(lenient.passed_over.empty());
  CHECK(lenient.notes == strict.notes);
}

TEST_CASE("lenient: what a picture that cannot be read would colour is grey, and the others stay") {
  const std::string good = "data:image/png;base64," + base64(plain_picture(1, 1, "abcd"));
  const std::string maps = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1],
      "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
    "normalTexture": {"index": 0, "scale": 3}, "occlusionTexture": {"index": 1, "strength": 0.5},
    "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1])";
  for (const char* bad : {"absent.png", "../out.png", "data:image/png;base64,AAAA", "C:/windows.png"}) {
    const Scene scene =
        passed(triangle_of_material(maps, R"("textures": [{"source": 0}, {"source": 1}], "images": [{"uri": ")" +
                                              std::string(bad) + R"("}, {"uri": ")" + good + "\"}]"),
               std::string(bad) == "absent.png" ? ErrorKind::io : ErrorKind::bad_input);
    CHECK_STARTS_WITH(the_fault(scene), "1 picture cannot be read, so what it colours is grey: ");
    CHECK(the_fault(scene).ends_with(
              " (add --trust-paths where you trust the file, to read what lies outside its folder)") ==
          (std::string(bad) == "../out.png"));
    const Material& m = scene.materials.at(0);
    CHECK(m.base_color == glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    CHECK(m.roughness == 0.5f);
    CHECK(m.metallic == 0.5f);
    CHECK(m.emission == glm::vec3(0.0f));
    CHECK(m.normal_scale == 1.0f);
    for (const TextureSlot* lost : {&m.color_map, &m.metallic_roughness_map, &m.normal_map, &m.emission_map})
      CHECK(!lost->used());
    REQUIRE(scene.textures.size() == 1);
    CHECK(m.occlusion_map.texture == 0);
    CHECK(scene.textures[0].levels[0].bytes[0] == 'a');
  }
}

TEST_CASE("lenient: a limit stays one") {
  SceneLimits limits = limits_with(Leniency::asked);
  limits.texture_bytes = 3;
  const std::string picture = "data:image/png;base64," + base64(plain_picture(1, 1, "abcd"));
  const std::string content =
      triangle_of_material(R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})",
                           R"("textures": [{"source": 0}], "images": [{"uri": ")" + picture + "\"}]");
  CHECK(gltf_refusal(content, ErrorKind::limit, limits).find("--lenient") == std::string::npos);
}

TEST_CASE("lenient: required extensions of materials and textures are left out, those of shapes are not") {
  const auto requiring = [](const std::string& name) {
    Asset asset;
    asset.accessor(kTriangle, "VEC3");
    return asset.gltf(
        one_primitive(R"("attributes": {"POSITION": 0})", "",
                      R"("extensionsUsed": [")" + name + R"("], "extensionsRequired": [")" + name + "\"]"));
  };
  for (const char* looks : {"KHR_materials_transmission", "KHR_materials_variants", "EXT_texture_webp",
                            "KHR_texture_basisu", "EXT_lights_image_based", "KHR_animation_pointer"}) {
    const Scene scene = passed(requiring(looks));
    CHECK_STARTS_WITH(the_fault(scene), "1 required extension is left out: ");
    CHECK(scene.passed_over[0].find(looks) != std::string::npos);
    CHECK(scene.triangle_count() == 1);
  }
  for (const char* shapes : {"KHR_draco_mesh_compression", "KHR_gaussian_splatting", "ACME_secret"})
    for (const Leniency leniency : {Leniency::offered, Leniency::asked})
      CHECK(gltf_refusal(requiring(shapes), ErrorKind::bad_input, limits_with(leniency)).find("--lenient") ==
            std::string::npos);
}

TEST_CASE("lenient: numbers that are not aligned, and strides that glTF has not, are read as they lie") {
  std::vector<uint8_t> bytes(3);  // positions begin at byte 1, 13 apart
  bytes.resize(1 + 3 * 13);
  for (size_t v = 0; v < 3; ++v) std::memcpy(bytes.data() + 1 + 13 * v, kTriangle.data() + 3 * v, 12);
  Asset asset;
  asset.view(bytes, R"("byteStride": 13)");
  asset.accessor(R"("bufferView": 0, "byteOffset": 1, "componentType": 5126, "count": 3, "type": "VEC3")");
  const Scene scene = passed(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})")));
  REQUIRE(scene.passed_over.size() == 2);
  CHECK(scene.passed_over[0].find("/accessors/0: the data do not start on a multiple of 4 bytes") != std::string::npos);
  CHECK(scene.passed_over[1].find("/bufferViews/0/byteStride: the stride is no multiple of 4") != std::string::npos);
  const Mesh& mesh = scene.meshes.at(0);
  for (size_t v = 0; v < 3; ++v)
    for (size_t k = 0; k < 3; ++k) CHECK(mesh.position[k][v] == kTriangle[3 * v + k]);
}

TEST_CASE("lenient: indices with a stride are read by it") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.view(std::vector<uint16_t>{2, 9, 0, 9, 1, 9}, R"("byteStride": 4, "target": 34963)");
  asset.accessor(R"("bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR")");
  const Scene scene = passed(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "indices": 1)")));
  const Mesh& mesh = scene.meshes.at(0);  // flat normals have given each corner its vertex
  CHECK(std::vector<float>(mesh.position[0].begin(), mesh.position[0].end()) == std::vector<float>{0, 0, 1});
  CHECK(std::vector<float>(mesh.position[1].begin(), mesh.position[1].end()) == std::vector<float>{1, 0, 0});
}

TEST_CASE("lenient: a stride never leads out of its view") {
  for (const char* stride : {"4", "5", "16", "252", "253", "65536", "4294967295"}) {
    Asset asset;
    asset.view(kTriangle, std::string("\"byteStride\": ") + stride);
    asset.accessor(R"("bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3")");
    const std::string content = asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})"));
    if (std::string(stride) == "4" || std::string(stride) == "5")  // overlapping elements, all within
      CHECK(load_gltf(content, limits_with(Leniency::asked)).triangle_count() == 1);
    else
      CHECK(
          gltf_refusal(content, ErrorKind::bad_input, limits_with(Leniency::asked)).find("do not fit into the view") !=
          std::string::npos);
  }
}

/// A triangle, and a hierarchy of three nodes in a row, each one unit further along x, of which the last draws it.
std::string chain(const std::string& roots) {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  return asset.gltf(R"("scenes": [{"nodes": )" + roots + R"(}],
    "nodes": [{"children": [1], "translation": [1, 0, 0]}, {"children": [2], "translation": [1, 0, 0]},
              {"mesh": 0, "translation": [1, 0, 0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}])");
}

TEST_CASE("lenient: a scene's node that is no root is drawn, and once") {
  const auto x = [](const Scene& scene) {
    REQUIRE(scene.instances.size() == 1);
    return scene.instances[0].world_from_object[3].x;
  };
  CHECK(x(passed(chain("[1]"))) == 2.0f);
  CHECK(x(passed(chain("[2]"))) == 1.0f);
  CHECK(x(passed(chain("[2, 0]"))) == 3.0f);
  CHECK(x(passed(chain("[0, 2, 1]"))) == 3.0f);
  CHECK(x(passed(chain("[0, 0]"))) == 3.0f);
}

TEST_CASE("lenient: a material's map has no texture coordinates in the mesh, and an attribute is none of glTF's") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string picture = "data:image/png;base64," + base64(plain_picture(1, 1, "abcd"));
  for (const char* set : {"0", "1", "7"}) {
    const Scene scene = passed(asset.gltf(one_primitive(
        R"("attributes": {"POSITION": 0}, "material": 0)", "",
        R"("materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": )" + std::string(set) +
            R"(}}}], "textures": [{"source": 0}], "images": [{"uri": ")" + picture + "\"}]")));
    CHECK(the_fault(scene).find("the material reads TEXCOORD_" + std::string(set)) != std::string::npos);
    CHECK(scene.triangle_count() == 1);
    const Scene bumpy = passed(asset.gltf(one_primitive(  // which would make tangents along them
        R"("attributes": {"POSITION": 0}, "material": 0)", "",
        R"("materials": [{"normalTexture": {"index": 0, "texCoord": )" + std::string(set) +
            R"(}}], "textures": [{"source": 0}], "images": [{"uri": ")" + picture + "\"}]")));
    CHECK_FALSE(bumpy.meshes.at(0).has_tangents());
  }
  CHECK(the_fault(passed(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "COLOUR": 0})"))))
            .find("this attribute is not in glTF") != std::string::npos);
}

/// Loads the file of a folder strictly, which is refused, and leniently.
Scene passed_file(const std::string& path, const std::string& reason) {
  for (const Leniency leniency : {Leniency::refused, Leniency::offered}) {
    std::string error;
    try {
      load_scene(path, limits_with(leniency), decode_plain);
    } catch (const Error& caught) {
      error = caught.what();
    }
    CHECK(error.find(reason) != std::string::npos);
    const std::string_view option = "--lenient";
    size_t named = 0;
    for (size_t at = error.find(option); at != std::string::npos; at = error.find(option, at + 1)) ++named;
    CHECK(named == (leniency == Leniency::offered ? 1u : 0u));
    CHECK((error.find(kHint) != std::string::npos) == (leniency == Leniency::offered));
  }
  return load_scene(path, limits_with(Leniency::asked), decode_plain);
}

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

TEST_CASE("lenient: a material library of OBJ that is missing leaves its materials grey") {
  const ScratchFolder folder;
  const Scene scene =
      passed_file(folder.write("m.obj", std::string("mtllib absent.mtl\n") + kObj), "absent.mtl: No such file");
  CHECK_STARTS_WITH(the_fault(scene), "1 material library cannot be read, so its materials are grey: ");
  CHECK(scene.materials.at(0).base_color.x == 0.7f);
}

TEST_CASE("lenient: pictures of MTL that are missing, and statements of wrong words") {
  const ScratchFolder folder;
  folder.write(
      "a.mtl",
      "newmtl m\nKd 1 0.5 0.5\nNs many\nmap_Kd absent.png\nmap_d C:\\x.png\nKs 1 1 1\nmap_Ks absent.png\nKe 1 1 "
      "1\nmap_Ke absent.png\nbump absent.png\nmap_Pr absent.png\nPr 0.5\n");
  const Scene scene = passed_file(folder.write("m.obj", std::string("mtllib a.mtl\n") + kObj), "a.mtl: line");
  REQUIRE(scene.passed_over.size() == 2);
  CHECK_STARTS_WITH(scene.passed_over[0], "2 pictures cannot be read, so what they colour is grey: ");
  CHECK_STARTS_WITH(scene.passed_over[1], "1 statement is left out: a.mtl: line 3: Ns is 'many'");
  const Material& m = scene.materials.at(0);
  CHECK(m.base_color == glm::vec4(0.5f, 0.25f, 0.25f, 1.0f));
  CHECK(m.specular_color == glm::vec3(0.5f));
  CHECK(m.emission == glm::vec3(0.0f));
  CHECK(m.roughness == 0.25f);
  CHECK(!m.textured());
  CHECK(m.alpha_cutoff == 0.0f);
  CHECK(scene.textures.empty());
}

TEST_CASE("lenient: an opacity map of MTL stays where the colour map beside it is lost") {
  const ScratchFolder folder;
  folder.write("holes.png", std::string("\x89PNG\r\n\x1a\n") + "\x01\x02" + "abc\xff" + std::string(4, '\0'));
  folder.write("a.mtl", "newmtl m\nmap_Kd absent.png\nmap_d holes.png\n");
  const Scene scene = passed_file(folder.write("m.obj", std::string("mtllib a.mtl\n") + kObj), "a.mtl: line 2");
  CHECK_STARTS_WITH(the_fault(scene),
                    "1 picture cannot be read, so what it colours is grey: a.mtl: line 2: absent.png");
  const Material& m = scene.materials.at(0);
  CHECK(m.alpha_cutoff > 0.0f);
  REQUIRE(m.color_map.used());
  const auto& bytes = scene.textures.at(size_t(m.color_map.texture)).levels.at(0).bytes;
  const std::vector<uint8_t> texels(bytes.begin(), bytes.end()), grey{188, 188, 188, 0, 188, 188, 188, 255};
  CHECK(texels == grey);  // sRGB of 0.5; the lower row is the first
}

TEST_CASE("lenient: what follows a newmtl that is passed over changes no other material") {
  const ScratchFolder folder;
  folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl m\nKd 0 1 0\nnewmtl red\nKd 0 0 1\n");
  const Scene scene =
      passed_file(folder.write("m.obj", std::string("mtllib m.mtl\n") + kObj), "a material of this name exists");
  const auto green = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [](const Material& material) { return material.name == "m"; });
  REQUIRE(green != scene.materials.end());
  CHECK(green->base_color == glm::vec4(0.0f, 1.0f, 0.0f, 1.0f));
}

TEST_CASE("lenient: statements of OBJ that cannot be read are left out, and indices keep their elements") {
  const ScratchFolder folder;
  const Scene scene =
      passed_file(folder.write("m.obj",
                               "v 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nwhat is this\nf 2 3\nf 2 3 4x\nvn 0 0\nvn 0 0 1\n"
                               "f 2//2 3//2 4//2\n"),
                  "m.obj: line 1: z is missing");
  CHECK_STARTS_WITH(the_fault(scene), "5 statements are left out: ");
  REQUIRE(scene.meshes.at(0).triangle_count() == 1);
  CHECK(scene.meshes[0].position[0][1] == 1.0f);
  CHECK(scene.meshes[0].normal[2][0] == 1.0f);
}

TEST_CASE("lenient: a face of OBJ that names what is not there is left out") {
  const ScratchFolder folder;
  const Scene scene =
      passed_file(folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1//1 2//1 3//1\nf 3 2 1\n"),
                  "m.obj: line 4: the index of a vertex is 9");
  CHECK_STARTS_WITH(the_fault(scene), "2 statements are left out: ");
  CHECK(scene.notes.size() == 1);
  error_of(ErrorKind::bad_input,
           [&] { load_scene(folder.write("none.obj", "f 1 2 3\n"), limits_with(Leniency::asked), decode_plain); });
}

TEST_CASE("lenient: a file that names a scene and has none draws all of its roots") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  CHECK(passed(
            asset.gltf(
                R"("scene": 0, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}])"))
            .triangle_count() == 1);
}

TEST_CASE("lenient: pictures of a scene file, and models that it names") {
  const ScratchFolder folder;
  folder.write("m.obj", std::string("mtllib absent.mtl\n") + kObj);
  folder.write("good.png", plain_picture(1, 1, "abcd"));
  const Scene scene =
      passed_file(folder.write("s.json", R"({"version": 1, "textures": [{"name": "a", "file": "absent.png"},
    {"name": "b", "file": "good.png"}], "materials": [{"name": "m", "color": [1, 1, 1], "color_map": {"texture": "a"},
    "specular_map": {"texture": "b"}}], "objects": [{"mesh": "cube", "material": "m"}, {"geometry": "m.obj"}]})"),
                  "absent.png: No such file");
  REQUIRE(scene.passed_over.size() == 2);
  CHECK(scene.passed_over[0].find("absent.mtl") != std::string::npos);
  CHECK(scene.passed_over[1].find("absent.png") != std::string::npos);
  CHECK(scene.materials.at(0).base_color == glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  CHECK(!scene.materials[0].color_map.used());
  REQUIRE(scene.textures.size() == 1);
  CHECK(scene.materials[0].specular_map.texture == 0);
}

TEST_CASE("lenient: of many faults five are named, and what a file says is printed without control characters") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  std::string images;
  for (int i = 0; i < 8; ++i) images += (i > 0 ? ", " : "") + (R"({"uri": "a\u001b)" + std::to_string(i) + ".png\"}");
  const Scene scene =
      passed(asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})", "", R"("images": [)" + images + "]")));
  const std::string line = the_fault(scene);
  CHECK_STARTS_WITH(line, "8 pictures cannot be read");
  CHECK(line.find("/images/4") != std::string::npos);
  CHECK(line.find("/images/5") == std::string::npos);
  CHECK(line.ends_with("; and 3 more"));
  CHECK(line.find('\x1b') == std::string::npos);
}

// --- PLY ------------------------------------------------------------------------------------------------------------

constexpr const char* kPlyFaces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

/// A triangle, and a face more: lines of the header in front of its elements, properties of a vertex besides x, y and
/// z, of which each is 1, and the other face.
std::string triangle_ply(const std::string& lines, const std::vector<std::string>& properties,
                         const std::string& face) {
  std::string text = "ply\nformat ascii 1.0\n" + lines + "element vertex 3\n", ones;
  for (const char* name : {"float x", "float y", "float z"}) text += std::string("property ") + name + '\n';
  for (const std::string& property : properties) text += "property " + property + '\n', ones += " 1";
  text += kPlyFaces;
  for (const char* place : {"0 0 0", "1 0 0", "0 1 0"}) text += place + ones + '\n';
  return text + "3 0 1 2\n" + face + '\n';
}

TEST_CASE("lenient: of a PLY file odd lines of the header, incomplete properties and thin faces are left out") {
  const ScratchFolder scratch;
  const auto load = [&](const std::string& text, Leniency leniency) {
    return load_scene(scratch.write("m.ply", text), limits_with(leniency), decode_plain);
  };
  const Scene whole = load(triangle_ply("", {}, "3 0 2 1"), Leniency::refused);
  struct Oddity {
    std::string text, reason;
  };
  const std::string full = "3 0 2 1";
  const std::vector<Oddity> oddities = {
      {triangle_ply("Created by Blender3D 247\n", {}, full), "line 3: 'Created' is no keyword of a PLY header"},
      {triangle_ply("\n", {}, full), "line 3: the line is empty"},
      {triangle_ply("", {"uchar red", "uchar blue"}, full), "only some of red, green, blue"},
      {triangle_ply("", {"int red", "int green", "int blue"}, full), "colours are of a signed or 32-bit type"},
      {triangle_ply("", {"float nx"}, full), "only some of nx to nz"},
      {triangle_ply("", {"float s"}, full), "only some of s to t"}};
  for (const Oddity& oddity : oddities) {
    const std::string strict = error_of(ErrorKind::bad_input, [&] { load(oddity.text, Leniency::offered); });
    CHECK(strict.find(oddity.reason) != std::string::npos);
    CHECK(strict.ends_with(kHint));
    const Scene scene = load(oddity.text, Leniency::asked);
    CHECK(the_fault(scene).find(oddity.reason) != std::string::npos);
    CHECK(scene_hash(scene) == scene_hash(whole));
  }
  const std::string thin = triangle_ply("", {}, "2 0 1");
  CHECK(error_of(ErrorKind::bad_input, [&] { load(thin, Leniency::offered); }).ends_with(kHint));
  const Scene scene = load(thin, Leniency::asked);
  CHECK(the_fault(scene).find("faces of fewer than 3 corners: 1") != std::string::npos);
  CHECK(scene.meshes.at(0).triangle_count() == 1);
  std::string lines;
  for (int i = 0; i < 257; ++i) lines += "odd\n";
  error_of(ErrorKind::limit, [&] { load(triangle_ply(lines, {}, full), Leniency::asked); });
  scratch.write("m.ply", oddities.front().text);
  const std::string json = scratch.write("s.json", R"({"version": 1, "objects": [{"geometry": "m.ply"}]})");
  CHECK(the_fault(load_scene(json, limits_with(Leniency::asked), decode_plain)).find("line 3") != std::string::npos);
}

// --- Paths ----------------------------------------------------------------------------------------------------------

SceneLimits trusting() {
  SceneLimits limits;
  limits.named_paths = NamedPaths::any;
  return limits;
}

TEST_CASE("trusted paths may be absolute, lead out of the folder and be links, and the rules of URIs stay") {
  CHECK(path_from_uri("/a/b.ply", "w", NamedPaths::any) == "/a/b.ply");
  CHECK(path_from_uri("../a.ply", "w", NamedPaths::any) == "../a.ply");
  for (const char* bad : {"", "a\\b", "a%00b", "http://x/a.ply", "C:/a.ply"})
    error_of(ErrorKind::bad_input, [&] { path_from_uri(bad, "w", NamedPaths::any); });
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { path_from_uri("C:/a.ply", "w"); }),
                    "w: the path begins with a drive of Windows");
  for (const char* outside : {"/a/b.ply", "../a.ply"})
    CHECK(error_of(ErrorKind::bad_input, [&] { path_from_uri(outside, "w"); }).find(", or --trust-paths where") !=
          std::string::npos);
  const ScratchFolder scratch;
  const std::string outside = scratch.write("outside.ply", "outside"), scene = scratch.write("scene/s.json", "{}");
  std::filesystem::create_symlink("../outside.ply", scratch.path("scene/link.ply"));
  const SceneFolder trusting_folder(scene, NamedPaths::any), strict(scene);
  for (const std::string& path : {outside, std::string("../outside.ply"), std::string("link.ply")}) {
    CHECK(trusting_folder.read(path, 100, "w").size() == 7);
    CHECK_NOTHROW(trusting_folder.check(path, 100, "w"));
    error_of(ErrorKind::bad_input, [&] { strict.read(path, 100, "w"); });
  }
  CHECK(error_of(ErrorKind::bad_input, [&] { strict.read("link.ply", 100, "w"); }).find("--trust-paths") !=
        std::string::npos);
  error_of(ErrorKind::limit, [&] { trusting_folder.read(outside, 6, "w"); });
  error_of(ErrorKind::bad_input, [&] { trusting_folder.read("/dev/null", 100, "w"); });
  error_of(ErrorKind::io, [&] { trusting_folder.read("/no/such/file", 100, "w"); });
}

TEST_CASE("trusted paths: every kind of file that a scene names is read from elsewhere") {
  const ScratchFolder scratch;
  const std::string far = scratch.path("far");
  scratch.write("far/p.png", plain_picture(1, 1, "abcd"));
  scratch.write("far/a.mtl", "newmtl m\nmap_Kd p.png\n");
  scratch.write("far/lights.csv", "1,2,3\n");
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  scratch.write("far/data.bin", asset.data());
  const std::string document =
      asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0)", "",
                               R"("materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}], "images": [{"uri": ")" +
                                   far + R"(/p.png"}])"),
                 far + "/data.bin");
  const std::vector<std::string> files = {
      scratch.write("here/m.gltf", document), scratch.write("here/m.obj", "mtllib " + far + "/a.mtl\n" + kObj),
      scratch.write("here/up.obj", std::string("mtllib ../far/a.mtl\n") + kObj),
      scratch.write("here/s.json", R"({"version": 1, "textures": [{"name": "t", "file": ")" + far +
                                       R"(/p.png"}], "objects": [{"geometry": "../here/m.obj"}]})"),
      scratch.write("here/other.json", R"({"version": 1, "scene": ")" + scratch.path("here/m.gltf") + "\"}")};
  for (const std::string& file : files) {
    INFO(file);
    CHECK(error_of(ErrorKind::bad_input, [&] { load_scene(file, {}, decode_plain); }).find("--trust-paths") !=
          std::string::npos);
    CHECK(load_scene(file, trusting(), decode_plain).textures.size() >= 1);
  }
}

}  // namespace
}  // namespace trueshade
