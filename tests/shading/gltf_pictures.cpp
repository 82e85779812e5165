// glTF files that say the same thing in different ways are one picture, byte for byte; what they say differs only where
// a test says that it does.
#include <algorithm>

#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/scenes/gltf/asset.h"

namespace trueshade {
namespace {

using Floats = std::vector<float>;

constexpr int kSide = 9;

/// How a file says it.
struct Way {
  const char* name;
  bool strips = false, interleaved = false, sparse = false, quantised = false, turned_keys = false, matrix = false;
  bool transform = false;        ///< of texture coordinates, in the file instead of the vertices
  bool other_set = false;        ///< texture coordinates are TEXCOORD_1, behind others that nothing reads
  bool extension_set = false;    ///< and the transform's extension says so
  const char* index = "uint16";  ///< or uint8, uint32, none
};

/// A sheet of kSide x kSide vertices whose numbers are integers of 8 and 16 bits, or such by 127, 255 or 65535.
struct Sheet {
  std::vector<int16_t> position;
  std::vector<int8_t> normal;
  std::vector<uint16_t> uv;
  std::vector<uint8_t> color;

  Sheet() {
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const int z = (3 * x + 5 * y) % 4;
        position.insert(position.end(), {int16_t(x - 4), int16_t(y - 4), int16_t(z), 0});
        normal.insert(normal.end(), {int8_t(10 * x - 40), int8_t(30 - 7 * y), int8_t(110), 0});
        uv.insert(uv.end(), {uint16_t(8191 * x), uint16_t(65535 - 5000 * y)});
        color.insert(color.end(), {uint8_t(255 - 20 * x), uint8_t(100 + 15 * y), 200, 255});
      }
  }
};
const Sheet kSheet;

/// c / most, rounded once, of the first `each` of every `stride` numbers.
template <typename T>
Floats floats(const std::vector<T>& codes, size_t stride, size_t each, double most) {
  Floats out;
  for (size_t i = 0; i < codes.size(); i += stride)
    for (size_t k = 0; k < each; ++k) out.push_back(float(double(codes[i + k]) / most));
  return out;
}

Floats coordinates(bool transformed) {
  Floats uv = floats(kSheet.uv, 2, 2, 65535);
  for (size_t i = 0; i < uv.size() && transformed; i += 2) {
    uv[i] = float(0.25 + 2.0 * double(uv[i]));
    uv[i + 1] = float(-1.0 + 0.5 * double(uv[i + 1]));
  }
  return uv;
}

std::string member(const char* name, int accessor) {
  return '"' + std::string(name) + "\": " + std::to_string(accessor);
}

/// Attributes of all vertices, as JSON members.
std::vector<std::string> attributes(const Way& way, Asset& asset) {
  const Floats uv = coordinates(!way.transform);
  const char* set = way.other_set ? "TEXCOORD_1" : "TEXCOORD_0";
  std::vector<std::string> out;
  if (way.interleaved) {
    const Floats position = floats(kSheet.position, 4, 3, 1), normal = floats(kSheet.normal, 4, 3, 127),
                 color = floats(kSheet.color, 4, 4, 255);
    Floats all;
    for (size_t v = 0; v < kSide * kSide; ++v) {
      const auto add = [&](const Floats& from, size_t n) {
        all.insert(all.end(), from.begin() + ptrdiff_t(v * n), from.begin() + ptrdiff_t((v + 1) * n));
      };
      add(position, 3), add(normal, 3), add(uv, 2), add(color, 4);
    }
    const std::string view = std::to_string(asset.view(all, R"("byteStride": 48)"));
    const auto part = [&](int offset, const char* type) {
      return asset.accessor(R"("bufferView": )" + view + R"(, "byteOffset": )" + std::to_string(offset) +
                            R"(, "componentType": 5126, "count": 81, "type": ")" + type + '"');
    };
    out = {member("POSITION", part(0, "VEC3")), member("NORMAL", part(12, "VEC3")), member(set, part(24, "VEC2")),
           member("COLOR_0", part(32, "VEC4"))};
  } else if (way.quantised) {
    const auto packed = [&](const auto& codes, const char* type, int component, const std::string& more, int stride) {
      const int view = asset.view(codes, R"("byteStride": )" + std::to_string(stride));
      return asset.accessor(R"("bufferView": )" + std::to_string(view) + R"(, "componentType": )" +
                            std::to_string(component) + R"(, "count": 81, "type": ")" + type + '"' + more);
    };
    const std::string normalized = R"(, "normalized": true)";
    out = {member("POSITION", packed(kSheet.position, "VEC3", 5122, "", 8)),
           member("NORMAL", packed(kSheet.normal, "VEC3", 5120, normalized, 4)),
           member(set, way.transform ? packed(kSheet.uv, "VEC2", 5123, normalized, 4) : asset.accessor(uv, "VEC2")),
           member("COLOR_0", packed(kSheet.color, "VEC4", 5121, normalized, 4))};
  } else {
    Floats position = floats(kSheet.position, 4, 3, 1);
    std::string sparse;
    if (way.sparse) {
      std::vector<uint8_t> at;
      Floats values;
      for (uint8_t v = 0; v < kSide * kSide; v = uint8_t(v + 3)) {
        at.push_back(v);
        values.insert(values.end(), position.begin() + 3 * v, position.begin() + 3 * v + 3);
        std::fill_n(position.begin() + 3 * v, 3, 99.0f);
      }
      const std::string indices = std::to_string(asset.view(at)), replaced = std::to_string(asset.view(values));
      sparse = R"("sparse": {"count": )" + std::to_string(at.size()) + R"(, "indices": {"bufferView": )" + indices +
               R"(, "componentType": 5121}, "values": {"bufferView": )" + replaced + "}}";
    }
    out = {member("POSITION", asset.accessor(position, "VEC3", sparse)),
           member("NORMAL", asset.accessor(floats(kSheet.normal, 4, 3, 127), "VEC3")),
           member(set, asset.accessor(uv, "VEC2")),
           member("COLOR_0", asset.accessor(floats(kSheet.color, 4, 4, 255), "VEC4"))};
  }
  if (way.other_set) out.push_back(member("TEXCOORD_0", asset.accessor(Floats(2 * kSide * kSide, 0.5f), "VEC2")));
  return out;
}

/// Corners of row y as a strip, counter-clockwise seen from +z.
std::vector<uint32_t> strip_of(int y) {
  std::vector<uint32_t> corners;
  for (int x = 0; x < kSide; ++x)
    for (const int row : {y + 1, y}) corners.push_back(uint32_t(row * kSide + x));
  return corners;
}

/// The triangles of a strip (glTF 2.0, 3.7.2.1).
std::vector<uint32_t> list_of(const std::vector<uint32_t>& strip) {
  std::vector<uint32_t> list;
  for (size_t i = 0; i + 2 < strip.size(); ++i)
    list.insert(list.end(), {strip[i], strip[i + 1 + i % 2], strip[i + 2 - i % 2]});
  return list;
}

std::string joined(std::vector<std::string> parts, bool turned) {
  if (turned) std::reverse(parts.begin(), parts.end());
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
  return out;
}

std::string color_texture(const Way& way) {
  std::vector<std::string> members{R"("index": 0)"}, extension;
  if (way.other_set && !way.extension_set) members.push_back(R"("texCoord": 1)");
  if (way.transform) extension = {R"("offset": [0.25, -1])", R"("scale": [2, 0.5])"};
  if (way.extension_set) extension.push_back(R"("texCoord": 1)");
  if (!extension.empty())
    members.push_back(R"("extensions": {"KHR_texture_transform": {)" + joined(extension, way.turned_keys) + "}}");
  return "{" + joined(members, way.turned_keys) + "}";
}

/// All of the document but its data: a primitive a row, of two materials by turns, below a node, and a light.
std::string rest_of(const Way& way, Asset& asset) {
  const std::string shared = joined(attributes(way, asset), way.turned_keys);
  std::vector<std::string> primitives;
  for (int y = 0; y + 1 < kSide; ++y) {
    const std::vector<uint32_t> corners = way.strips ? strip_of(y) : list_of(strip_of(y));
    const std::string index(way.index);
    const int indices =
        index == "uint8"    ? asset.accessor(std::vector<uint8_t>(corners.begin(), corners.end()), "SCALAR")
        : index == "uint16" ? asset.accessor(std::vector<uint16_t>(corners.begin(), corners.end()), "SCALAR")
                            : asset.accessor(corners, "SCALAR");
    primitives.push_back(
        "{" +
        joined({R"("attributes": {)" + shared + "}", member("indices", indices),
                R"("material": )" + std::to_string(y % 2), R"("mode": )" + std::string(way.strips ? "5" : "4")},
               way.turned_keys) +
        "}");
  }
  const std::string picture =
      base64(std::string("\x89PNG\r\n\x1a\n\x04\x03") + "q\x10\x20\x30\x40\x70zabc!RDX\x90\xa0");
  const std::string node = way.matrix
                               ? R"("matrix": [0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.25, 0, 0.5, -0.25, 0.125, 1])"
                               : R"("scale": [0.25, 0.25, 0.25], "translation": [0.5, -0.25, 0.125])";
  return joined(
      {R"("extensionsUsed": ["KHR_lights_punctual", "KHR_mesh_quantization", "KHR_texture_transform"])",
       R"("extensionsRequired": ["KHR_texture_transform"])", R"("scenes": [{"nodes": [0, 1]}])",
       R"("nodes": [{"mesh": 0, )" + node +
           R"(}, {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}])",
       R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40}]}})",
       R"("meshes": [{"primitives": [)" + joined(primitives, false) + "]}]",
       R"("materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.25, "roughnessFactor": 0.5, "baseColorTexture": )" +
           color_texture(way) + R"(}}, {"pbrMetallicRoughness": {"metallicFactor": 0}}])",
       R"("textures": [{"source": 0}])", R"("images": [{"uri": "data:image/png;base64,)" + picture + R"("}])"},
      way.turned_keys);
}

Image picture_of(const Scene& scene, CullFace cull = CullFace::back) {
  Pipeline pipeline = default_pipeline(scene);
  CHECK(pipeline.geometry.cull_face == CullFace::back);
  pipeline.geometry.cull_face = cull;
  pipeline.width = 96, pipeline.height = 80;
  return render_frame(scene, pipeline).color;
}

std::string hash_of(const std::string& document, const std::string& ending = ".gltf") {
  return image_hash(picture_of(load_gltf(document, {}, ending)));
}

std::string document(const Way& way) {
  Asset asset;
  const std::string rest = rest_of(way, asset);
  return asset.gltf(rest);
}

TEST_CASE("files that say the same thing in different ways are one picture") {
  const Way plain{"plain"};
  const Image picture = picture_of(load_gltf(document(plain)));
  const std::string expected = image_hash(picture);
  int shown = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) shown += picture.value(x, y, 0) != picture.value(0, 0, 0) ? 1 : 0;
  CHECK(shown > picture.width * picture.height / 10);
  const Way ways[] = {{.name = "strips", .strips = true},
                      {.name = "interleaved", .interleaved = true},
                      {.name = "sparse", .sparse = true},
                      {.name = "quantised", .quantised = true},
                      {.name = "keys the other way round", .turned_keys = true},
                      {.name = "a matrix", .matrix = true},
                      {.name = "indices of 8 bits", .index = "uint8"},
                      {.name = "indices of 32 bits", .index = "uint32"},
                      {.name = "a transform of texture coordinates", .transform = true},
                      {.name = "the second set", .other_set = true},
                      {.name = "the second set, by the extension", .other_set = true, .extension_set = true},
                      {.name = "a transform of the second set",
                       .turned_keys = true,
                       .transform = true,
                       .other_set = true,
                       .extension_set = true},
                      {.name = "many of these",
                       .strips = true,
                       .quantised = true,
                       .turned_keys = true,
                       .matrix = true,
                       .transform = true,
                       .other_set = true,
                       .index = "uint32"}};
  for (const Way& way : ways) {
    INFO(way.name);
    CHECK(document(way) != document(plain));
    CHECK(hash_of(document(way)) == expected);
  }
}

TEST_CASE("a picture comes from data URIs, from files beside and from a container alike") {
  const Way plain{"plain"};
  Asset asset;
  const std::string rest = rest_of(plain, asset), expected = hash_of(asset.gltf(rest));
  CHECK(hash_of(asset.glb(rest), ".glb") == expected);
  const ScratchFolder scratch;
  scratch.write("data.bin", asset.data());
  const Scene beside = load_scene(scratch.write("s.gltf", asset.gltf(rest, "data.bin")), {}, decode_plain);
  CHECK(image_hash(picture_of(beside)) == expected);
}

TEST_CASE("a transform that the extension does not give is another picture") {
  const std::string with = document({.name = "", .transform = true});
  std::string without = with;
  const size_t at = without.find(R"("scale": [2, 0.5])");
  REQUIRE(at != std::string::npos);
  without.replace(at, 17, R"("scale": [2, 0.6])");
  CHECK(hash_of(with) != hash_of(without));
}

// --- Faces ---------------------------------------------------------------------------------------------------------

/// A bent sheet of four triangles, x and normals negated and corners turned round where `mirrored`.
std::string bent_sheet(bool mirrored, bool turned, const std::string& node, bool double_sided) {
  const float s = mirrored ? -1.0f : 1.0f;
  Asset asset;
  asset.accessor(Floats{-s, -1, 0.5f, 0, -1, 0, s, -1, 0.25f, -s, 1, 0.25f, 0, 1, 0, s, 1, 0.5f}, "VEC3");
  asset.accessor(
      Floats{0.6f * s, 0, 0.8f, 0, 0, 1, -0.28f * s, 0, 0.96f, 0.28f * s, 0, 0.96f, 0, 0, 1, -0.6f * s, 0, 0.8f},
      "VEC3");
  std::vector<uint8_t> corners{0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4};
  for (size_t i = 0; i < corners.size() && turned; i += 3) std::swap(corners[i + 1], corners[i + 2]);
  asset.accessor(corners, "SCALAR");
  return asset.gltf(
      R"("extensionsUsed": ["KHR_lights_punctual"], "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0)" + node +
      R"(}, {"translation": [0.5, 1, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40}]}},
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
    "materials": [{"doubleSided": )" +
      std::string(double_sided ? "true" : "false") + R"(, "pbrMetallicRoughness": {"metallicFactor": 0}}])");
}

/// Pixels that are not the background's.
int shown_in(const Image& picture) {
  int shown = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) shown += picture.value(x, y, 0) != picture.value(0, 0, 0) ? 1 : 0;
  return shown;
}

TEST_CASE(
    "a node that mirrors is the picture of the mirrored mesh, its corners turned round, with and without culling") {
  for (const bool double_sided : {false, true})
    for (const CullFace cull : {CullFace::back, CullFace::none, CullFace::front}) {
      const Scene by_node = load_gltf(bent_sheet(false, false, R"(, "scale": [-1, 1, 1])", double_sided));
      const Scene by_mesh = load_gltf(bent_sheet(true, true, "", double_sided));
      CHECK(by_node.instances.at(0).mirrored);
      CHECK(!by_mesh.instances.at(0).mirrored);
      const Image a = picture_of(by_node, cull), b = picture_of(by_mesh, cull);
      INFO("double-sided " << double_sided << ", cull_face " << int(cull));
      CHECK((shown_in(a) > 0) == (cull != CullFace::front));
      CHECK(image_hash(a) == image_hash(b));
    }
}

TEST_CASE(
    "a double-sided sheet seen from behind is the sheet with its normals the other way and its corners turned round") {
  const std::string behind = R"(, "rotation": [0, 1, 0, 0])";  // half a turn about y
  const Scene one = load_gltf(bent_sheet(false, false, behind, false));
  CHECK(shown_in(picture_of(one)) == 0);
  const Image back = picture_of(load_gltf(bent_sheet(false, false, behind, true)));
  CHECK(shown_in(back) > 500);
  // Half a turn about y is a mirror in x and one in z; of the latter normals that point along -z are turned.
  std::string turned = bent_sheet(false, true, behind, false);
  Scene front = load_gltf(turned);
  for (Mesh& mesh : front.meshes)
    for (auto& stream : mesh.normal)
      for (float& n : stream) n = -n;
  CHECK(image_hash(picture_of(front)) == image_hash(back));
  CHECK(image_hash(picture_of(load_gltf(turned))) != image_hash(back));  // lit from the other side
}

TEST_CASE("a node that an animation mirrors shows its other faces from then on") {
  Asset asset;
  asset.accessor(Floats{-1, -1, 0, 1, -1, 0, 0, 1, 0}, "VEC3");
  asset.accessor(Floats{0, 1}, "SCALAR");
  asset.accessor(Floats{1, 1, 1, -1, 1, 1}, "VEC3");
  Scene scene = load_gltf(asset.gltf(
      R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"samplers": [{"input": 1, "output": 2, "interpolation": "STEP"}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}]}])"));
  CHECK(shown_in(picture_of(scene)) > 500);
  set_time(scene, 1.0);
  CHECK(scene.instances.at(0).mirrored);
  CHECK(shown_in(picture_of(scene)) > 500);
  scene.instances[0].mirrored = false;
  CHECK(shown_in(picture_of(scene)) == 0);
}

}  // namespace
}  // namespace trueshade
