#include "../expect_error.h"
#include "asset.h"

namespace trueshade {
namespace {

const std::string kDocument = R"({"asset": {"version": "2.0"}})";

/// A .glb file with one byte or word of it replaced.
std::string with_word(std::string file, size_t at, uint32_t word) {
  std::memcpy(file.data() + at, &word, 4);
  return file;
}

std::string glb_refusal(const std::string& content) { return gltf_refusal(content, ErrorKind::bad_input, {}, ".glb"); }

TEST_CASE("a container of version 2 is split into JSON and BIN") {
  CHECK(load_gltf(glb_of(kDocument, ""), {}, ".glb").instances.empty());
  CHECK(load_gltf(glb_of(kDocument, "abcd"), {}, ".glb").instances.empty());
  const std::string more = std::string("\4\0\0\0ABCDefgh", 12);  // a chunk of another type
  const std::string file = glb_of(kDocument, "abcd") + more;
  CHECK(load_gltf(with_word(file, 8, uint32_t(file.size())), {}, ".glb").instances.empty());
  CHECK(load_gltf(glb_of(kDocument, "") + "what follows the length is not read", {}, ".glb").instances.empty());
  CHECK(load_gltf(glb_of(kDocument, ""), {}, ".gltf").instances.empty());  // the magic number tells
}

TEST_CASE("a broken container is refused with the byte where it breaks") {
  const std::string good = glb_of(kDocument, "abcd");
  const uint32_t json_bytes = uint32_t((kDocument.size() + 3) / 4 * 4), bin = 20 + json_bytes;
  CHECK_STARTS_WITH(glb_refusal(""), ": byte 0: the file ends inside the header");
  CHECK_STARTS_WITH(glb_refusal("glTF"), ": byte 4: the file ends inside the header");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 0, 0x46546C68)), ": byte 0: a .glb file starts with 'glTF'");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 4, 1)), ": byte 4: the container has version 1");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 8, 12)), ": byte 8: the header says 12 bytes, too few for a chunk");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 8, uint32_t(good.size() + 1))), ": byte 8: the header says ");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 12, json_bytes + 1)), ": byte 12: a chunk's length is no multiple");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 12, 0xFFFFFFFC)), ": byte 12: a chunk of 4294967292 bytes reaches");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 12, 0)), ": byte 12: the chunk JSON is empty");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 16, 0x004E4942)), ": byte 12: the first chunk is not JSON");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, bin + 4, 0x4E4F534A)),
                    ": byte " + std::to_string(bin) + ": there are two chunks JSON");
  // The BIN chunk's 8 header bytes are missing: the length that is left must not be taken for the chunk's.
  CHECK_STARTS_WITH(glb_refusal(with_word(good, 8, bin + 4)), ": byte " + std::to_string(bin) + ": a chunk's header");
  CHECK_STARTS_WITH(glb_refusal(with_word(good, bin, 8)), ": byte " + std::to_string(bin) + ": a chunk of 8 bytes");
  const std::string two = good + good.substr(bin), third = std::string("\0\0\0\0ABCD", 8);
  CHECK_STARTS_WITH(glb_refusal(with_word(two, 8, uint32_t(two.size()))),
                    ": byte " + std::to_string(good.size()) + ": there are two chunks BIN");
  const std::string late = good.substr(0, bin) + third + good.substr(bin);
  CHECK_STARTS_WITH(glb_refusal(with_word(late, 8, uint32_t(late.size()))),
                    ": byte " + std::to_string(bin + 8) + ": the chunk BIN is not the second one");
}

TEST_CASE("every prefix of a .glb file is refused") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string file = asset.glb(one_primitive(R"("attributes": {"POSITION": 0})"));
  CHECK(load_gltf(file, {}, ".glb").triangle_count() == 1);
  for (size_t bytes = 0; bytes < file.size(); ++bytes) glb_refusal(file.substr(0, bytes));
}

TEST_CASE("the asset's version decides whether a document is read") {
  const auto versions = [](const std::string& text) { return R"({"asset": {)" + text + "}}"; };
  CHECK(load_gltf(versions(R"("version": "2.7")")).instances.empty());
  CHECK(load_gltf(versions(R"("version": "2.7", "minVersion": "2.0")")).instances.empty());
  CHECK_STARTS_WITH(gltf_refusal("{}"), ": 'asset' is missing");
  CHECK_STARTS_WITH(gltf_refusal("[]"), ": found an array (an object)");
  CHECK_STARTS_WITH(gltf_refusal(versions("")), ": /asset: 'version' is missing");
  CHECK_STARTS_WITH(gltf_refusal(versions(R"("version": 2)")), ": /asset/version: found 2 (a string)");
  CHECK_STARTS_WITH(gltf_refusal(versions(R"("version": "1.0")")), ": /asset/version: the version is 1");
  for (const char* text : {"2", "2.", ".0", "2.0.0", "2.x", "-2.0", "2.-1", ""})
    CHECK_STARTS_WITH(gltf_refusal(versions(R"("version": ")" + std::string(text) + '"')),
                      ": /asset/version: the version is not of the form");
  CHECK_STARTS_WITH(gltf_refusal(versions(R"("version": "2.0", "minVersion": "2.1")")),
                    ": /asset/minVersion: minVersion is above version");
  CHECK_STARTS_WITH(gltf_refusal(versions(R"("version": "2.1", "minVersion": "2.1")")),
                    ": /asset/minVersion: a reader of glTF 2.1 is needed");
}

TEST_CASE("required extensions that are not implemented are refused by name, others are passed over") {
  const auto extensions = [](const std::string& lists) { return R"({"asset": {"version": "2.0"}, )" + lists + "}"; };
  CHECK(load_gltf(
            extensions(R"("extensionsUsed": ["EXT_unknown"], "extensions": {"EXT_unknown": {"x": 1}}, "extras": 7)"))
            .instances.empty());
  CHECK(load_gltf(extensions(R"("extensionsUsed": ["EXT_a", "KHR_lights_punctual", "EXT_b"])")).notes ==
        std::vector<std::string>{"2 extensions are not read, and the file is drawn as if it had none: EXT_a, EXT_b"});
  CHECK(load_gltf(extensions(R"("extensionsUsed": ["EXT_a", "KHR_texture_transform", "KHR_materials_unlit"], )"
                             R"("extensionsRequired": ["KHR_materials_unlit"])"))
            .extensions == std::vector<SceneExtension>{{"EXT_a", false, false},
                                                       {"KHR_texture_transform", false, true},
                                                       {"KHR_materials_unlit", true, true}});
  CHECK(
      load_gltf(
          extensions(R"("extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"])"))
          .instances.empty());
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensionsUsed": ["A_b"], "extensionsRequired": ["A_b"])")),
                    ": /extensionsRequired/0: the required extension \"A_b\" is not implemented (export without it; "
                    "implemented are ");
  for (const std::string name : {"KHR_texture_transform", "KHR_materials_unlit"})
    CHECK(load_gltf(extensions(R"("extensionsUsed": [")" + name + R"("], "extensionsRequired": [")" + name + R"("])"))
              .instances.empty());
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensionsUsed": ["A", "B", "A"])")),
                    ": /extensionsUsed/2: an extension is named twice");
  // What cannot be read at all is told before what is missing beside it.
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensionsUsed": ["A_b"], "extensionsRequired": ["A_b"], )"
                                            R"("buffers": [{"uri": "there_is_none.bin", "byteLength": -4}], )"
                                            R"("bufferViews": [{"buffer": 7}])")),
                    ": /extensionsRequired/0: the required extension \"A_b\" is not implemented");
  const std::string quantization = R"("KHR_mesh_quantization")";
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensionsUsed": [)" + quantization + R"(], "extensionsRequired": [)" +
                                            quantization + ", " + quantization + "]")),
                    ": /extensionsRequired/1: an extension is named twice");
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensionsRequired": ["KHR_mesh_quantization"])")),
                    ": /extensionsRequired/0: a required extension is not among extensionsUsed");
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensions": 1)")), ": /extensions: found 1 (an object)");
  CHECK_STARTS_WITH(gltf_refusal(extensions(R"("extensions": {"A_b": []})")), ": /extensions/A_b: found an array");
}

TEST_CASE("buffers come from data URIs, files and the chunk BIN, and must be whole") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string rest = one_primitive(R"("attributes": {"POSITION": 0})");
  const std::string expected = scene_hash(load_gltf(asset.gltf(rest)));
  CHECK(scene_hash(load_gltf(asset.glb(rest), {}, ".glb")) == expected);
  const ScratchFolder scratch;
  scratch.write("sub/a b.bin", asset.data() + "data behind byteLength are not read");
  for (const char* uri : {"sub/a%20b.bin", "sub/a b.bin", "./sub/../sub/a%20b.bin"})
    CHECK(scene_hash(load_scene(scratch.write("s.gltf", asset.gltf(rest, uri)))) == expected);
  const std::string percent = "data:application/gltf-buffer," + [&] {
    std::string text;
    constexpr char kHex[] = "0123456789ABCDEF";
    for (const char c : asset.data()) ((text += '%') += kHex[uint8_t(c) >> 4]) += kHex[uint8_t(c) & 15];
    return text;
  }();
  CHECK(scene_hash(load_gltf(asset.gltf(rest, percent))) == expected);

  const auto buffer = [](const std::string& members) {
    return R"({"asset": {"version": "2.0"}, "buffers": [{)" + members + "}]}";
  };
  const auto refused = [&](const std::string& uri, int bytes = 3) {
    return gltf_refusal(buffer(R"("uri": ")" + uri + R"(", "byteLength": )" + std::to_string(bytes)));
  };
  const std::string kind = "data:application/octet-stream;base64,";
  CHECK(load_gltf(buffer(R"("uri": ")" + kind + R"(AAEC", "byteLength": 3)")).instances.empty());
  for (const char* in_capitals : {"DATA:application/octet-stream;BASE64,", "data:application/octet-stream;Base64,"})
    CHECK_STARTS_WITH(refused(std::string(in_capitals) + "AAEC", 4), ": /buffers/0: there are 3 bytes");
  CHECK_STARTS_WITH(refused(kind + "AAEC", 4), ": /buffers/0: there are 3 bytes and byteLength says 4");
  CHECK_STARTS_WITH(refused(kind + "AAE"), ": /buffers/0/uri: the length of the base64 is no multiple of 4");
  CHECK_STARTS_WITH(refused(kind + "A=EC"), ": /buffers/0/uri: the base64 has a wrong character at 1");
  CHECK_STARTS_WITH(refused(kind + "====", 1), ": /buffers/0/uri: the base64 has a wrong character");
  CHECK_STARTS_WITH(refused(kind + "AA C"), ": /buffers/0/uri: the base64 has a wrong character at 2");
  CHECK_STARTS_WITH(refused("data:text/plain;base64,AAEC"), ": /buffers/0/uri: the data URI is not of a buffer's type");
  CHECK_STARTS_WITH(refused("data:application/octet-stream,%0"), ": /buffers/0/uri: the data URI has a % without");
  CHECK_STARTS_WITH(refused("data:application/octet-stream,a b"), ": /buffers/0/uri: the data URI has a character");
  CHECK_STARTS_WITH(refused("data:application/octet-stream"), ": /buffers/0/uri: the data URI has no comma");
  CHECK_STARTS_WITH(refused("http://example.com/a.bin"), ": /buffers/0/uri: the path has a scheme");
  CHECK_STARTS_WITH(refused("../a.bin"), ": /buffers/0/uri: the path leaves the scene's folder");
  CHECK_STARTS_WITH(refused("/etc/passwd"), ": /buffers/0/uri: the path is absolute");
  CHECK_STARTS_WITH(refused("%2e%2e/a.bin"), ": /buffers/0/uri: the path leaves the scene's folder");
  gltf_refusal(buffer(R"("uri": "missing.bin", "byteLength": 3)"), ErrorKind::io);
  CHECK_STARTS_WITH(gltf_refusal(buffer(R"("byteLength": 0)")), ": /buffers/0/byteLength: found 0");
  CHECK_STARTS_WITH(gltf_refusal(glb_of(buffer(R"("byteLength": 4)"), ""), ErrorKind::bad_input, {}, ".glb"),
                    ": /buffers/0: the file has no chunk BIN for this buffer");
  SceneLimits limits;
  limits.buffer_bytes = 2;
  CHECK_STARTS_WITH(gltf_refusal(buffer(R"("uri": ")" + kind + R"(AAEC", "byteLength": 3)"), ErrorKind::limit, limits),
                    ": /buffers/0/uri: the data are over the limit (at most 2 bytes, or a higher");
}

}  // namespace
}  // namespace trueshade
