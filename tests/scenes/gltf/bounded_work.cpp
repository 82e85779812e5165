#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "../expect_error.h"
#include "asset.h"
#include "core/memory_cap.h"
#include "scenes/files/gltf/mikk_tangents.h"
#include "scenes/scene_defaults.h"

// Small files that name much work: it stays in proportion to the file, or the file is refused.
namespace trueshade {
namespace {

/// Seconds of processor time, far below what quadratic work takes and far above what linear work does.
constexpr double kFewSeconds = 4.0;

template <typename Body>
double cpu_seconds(const Body& body) {
  const std::clock_t start = std::clock();
  body();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// `count` times `element`, with commas between.
std::string repeated(const std::string& element, size_t count) {
  std::string list;
  for (size_t i = 0; i < count; ++i) list += (i > 0 ? ", " : "") + element;
  return list;
}

/// An accessor of `count` zeros.
std::string zeros(size_t count, const std::string& type) {
  return R"("componentType": 5126, "count": )" + std::to_string(count) + R"(, "type": ")" + type + '"';
}

TEST_CASE("the reach of a posed mesh is measured once for all its copies") {
  Asset asset;
  asset.accessor(zeros(300000, "VEC3"));
  asset.accessor(zeros(100000, "VEC3"));
  const std::string text =
      asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "NORMAL": 0}, "targets": [{"POSITION": 0}])",
                               R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}})"));
  CHECK(cpu_seconds([&] { CHECK(load_gltf(text).instances.size() == 100000); }) < kFewSeconds);
}

TEST_CASE("a vertex that many triangles tear apart takes no more time than as many vertices") {
  Mesh mesh;  // of triangles that share the origin, and no edge
  const auto add = [&mesh](float x, float y, float u, float v) {
    const float values[] = {x, y, 0.0f, 0.0f, 0.0f, 1.0f};
    for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(values[k]), mesh.normal[k].push_back(values[3 + k]);
    mesh.uv[0].push_back(u), mesh.uv[1].push_back(v);
  };
  add(0, 0, 0, 0);
  constexpr uint32_t kTriangles = 60000;  // squared, many seconds of work
  for (uint32_t i = 0; i < kTriangles; ++i) {
    const auto turn = float(i);
    add(1, turn, 1, 0), add(-turn, 1, 0, 1);
    for (const uint32_t corner : {0u, 2 * i + 1, 2 * i + 2}) mesh.indices.push_back(corner);
  }
  CHECK(cpu_seconds([&] { gltf::add_mikk_tangents(mesh.uv, mesh); }) < kFewSeconds);
  CHECK(mesh.vertex_count() > 2 * kTriangles + kTriangles / 2);
}

TEST_CASE("posed meshes are counted as geometry, with the weights of their targets") {
  Asset asset;
  asset.accessor(zeros(3, "VEC3"));
  const auto text = [&](size_t nodes) {
    return asset.gltf(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "targets": [)" +
                      repeated(R"({"POSITION": 0})", 1000) + R"(]}]}], "nodes": [)" +
                      repeated(R"({"mesh": 0})", nodes) + "]");
  };
  SceneLimits limits;
  limits.geometry_bytes = 201000;
  CHECK(load_gltf(text(4), limits).meshes.size() == 4);
  CHECK_STARTS_WITH(gltf_refusal(text(100), ErrorKind::limit, limits),
                    ": /meshes/0/primitives/0: with these 9");  // 8,000 bytes of weights, and the mesh
}

TEST_CASE("the triangles of strips and fans are counted as geometry") {
  for (const char* mode : {"5", "6"}) {
    Asset asset;
    asset.accessor(zeros(3, "VEC3"));
    asset.accessor(R"("componentType": 5125, "count": 1000, "type": "SCALAR")");
    const std::string text = asset.gltf(
        one_primitive(R"("attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "mode": )" + std::string(mode)));
    SceneLimits limits;
    limits.geometry_bytes = 20000;
    CHECK(load_gltf(text, limits).triangle_count() == 998);
    limits.geometry_bytes = 10000;
    CHECK_STARTS_WITH(gltf_refusal(text, ErrorKind::limit, limits),
                      ": /meshes/0/primitives/0: with these 11976 bytes the geometry is over the limit");
  }
}

TEST_CASE("primitives that are not drawn are counted once a mesh") {
  constexpr size_t kMany = 60000;
  Asset asset;
  asset.accessor(zeros(1, "VEC3"));
  const std::string text =
      asset.gltf(R"("meshes": [{"primitives": [)" + repeated(R"({"attributes": {"POSITION": 0}, "mode": 0})", kMany) +
                 R"(]}], "nodes": [)" + repeated(R"({"mesh": 0})", kMany) + "]");
  CHECK(cpu_seconds([&] {
          CHECK(load_gltf(text).notes.at(0) ==
                "3600000000 primitives of points are not drawn, because only triangles are drawn");
        }) < kFewSeconds);
}

TEST_CASE("copies of a mesh are counted as geometry") {
  Asset asset;
  asset.accessor(zeros(3, "VEC3"));
  asset.accessor(zeros(1000, "VEC3"));
  const std::string text =
      asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})",
                               R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}})"));
  SceneLimits limits;
  limits.geometry_bytes = 1000000;
  CHECK(load_gltf(text, limits).instances.size() == 1000);
  limits.geometry_bytes = 100000;
  CHECK_STARTS_WITH(gltf_refusal(text, ErrorKind::limit, limits), ": /nodes/0: with these ");
}

/// What the process may have is less while this exists.
struct ScopedMemoryCap {
  explicit ScopedMemoryCap(uint64_t more) : before(memory_cap()) { set_memory_cap(resident_memory() + more); }
  ~ScopedMemoryCap() { set_memory_cap(before); }
  ScopedMemoryCap(const ScopedMemoryCap&) = delete;
  ScopedMemoryCap& operator=(const ScopedMemoryCap&) = delete;
  uint64_t before;
};

TEST_CASE("instances of nodes times primitives are counted before the first is made") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const auto text = [&](size_t nodes) {
    return asset.gltf(R"("meshes": [{"primitives": [)" + repeated(R"({"attributes": {"POSITION": 0}})", 300) +
                      R"(]}], "nodes": [)" + repeated(R"({"mesh": 0})", nodes) + "]");
  };
  SceneLimits limits;
  limits.instances = 1000;
  CHECK(load_gltf(text(3), limits).instances.size() == 900);
  CHECK_STARTS_WITH(gltf_refusal(text(5), ErrorKind::limit, limits), ": /nodes/3: the instances are over the limit");
  const std::string many = text(20000);
  const ScopedMemoryCap cap(uint64_t(200) << 20);
  const std::string refused = gltf_refusal(many, ErrorKind::limit);
  CHECK_STARTS_WITH(refused, ": /nodes: ");
  CHECK(refused.find("--max-memory") != std::string::npos);
  CHECK(resident_memory() < memory_cap());
}

TEST_CASE("zeros that stand for no data are held to the limit of expansion") {
  Asset asset;
  const int at = asset.view(std::vector<uint32_t>{99999999}), values = asset.view(std::vector<float>{2, 2, 2, 2});
  asset.accessor(zeros(100000000, "VEC3"));
  asset.accessor(zeros(100000000, "VEC4") + R"(, "sparse": {"count": 1, "indices": {"bufferView": )" +
                 std::to_string(at) + R"(, "componentType": 5125}, "values": {"bufferView": )" +
                 std::to_string(values) + "}}");
  const std::string text = asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "COLOR_0": 1})"));
  const ScopedMemoryCap cap(uint64_t(2000) << 20);  // what is allocated is less than what would be refused by this
  const std::string refused = gltf_refusal(text, ErrorKind::limit);
  CHECK_STARTS_WITH(
      refused, ": /accessors/0: with it the accessors without a buffer view are 400000000 bytes and all buffers 24");
  CHECK(refused.find("--max-expansion") != std::string::npos);
  SceneLimits limits;
  limits.geometry_bytes = 300000000;
  limits.expansion = 1 << 30;
  CHECK_STARTS_WITH(gltf_refusal(text, ErrorKind::limit, limits), ": /accessors/0: with these 400000000 bytes");
}

TEST_CASE("what all primitives read is added up before the first is read") {
  Asset asset;
  std::vector<float> positions(3000, 0.0f);
  positions[0] = std::nanf("");
  asset.accessor(positions, "VEC3");
  std::string primitives;
  for (uint32_t i = 0; i < 50; ++i)
    primitives += (i > 0 ? ", " : "") + std::string(R"({"attributes": {"POSITION": 0}, "indices": )") +
                  std::to_string(asset.accessor(std::vector<uint32_t>{i, i + 1, i + 2}, "SCALAR")) + "}";
  const std::string text = asset.gltf(R"("meshes": [{"primitives": [)" + primitives + R"(]}], "nodes": [{"mesh": 0}])");
  SceneLimits limits;
  limits.geometry_bytes = 50 * (12000 + 12);
  CHECK_STARTS_WITH(gltf_refusal(text, ErrorKind::bad_input, limits), ": /accessors/0: element 0 is not finite");
  --limits.geometry_bytes;
  CHECK_STARTS_WITH(gltf_refusal(text, ErrorKind::limit, limits),
                    ": /accessors/50: with these 12 bytes the geometry is over the limit");
}

TEST_CASE("pictures are looked for before copies are made") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(zeros(3000000, "VEC3"));
  const std::string text =
      asset.gltf(one_primitive(R"("attributes": {"POSITION": 0})",
                               R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}})",
                               R"("images": [{"uri": "none.png"}])"));
  CHECK(gltf_refusal(text, ErrorKind::io).find("none.png") != std::string::npos);
}

TEST_CASE("headers of all pictures are read before the first is decoded, and images of one view are one picture") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  const std::string magic = "\x89PNG\r\n\x1a\n", whole = magic + "\2\2abcd";
  const auto view = [&](const std::string& bytes) {
    return std::to_string(asset.view(std::vector<char>(bytes.begin(), bytes.end())));
  };
  const std::string good = view(whole), broken = view(magic);
  const auto text = [&](const std::string& last) {
    std::string primitives, materials, textures, images;
    for (int i = 0; i < 17; ++i) {
      const std::string comma = i > 0 ? ", " : "", index = std::to_string(i);
      primitives += comma + R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": )" + index + "}";
      materials += comma + R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": )" + index + "}}}";
      textures += comma + R"({"source": )" + index + "}";
      images += comma + R"({"mimeType": "image/png", "bufferView": )" + (i < 16 ? good : last) + "}";
    }
    return asset.gltf(R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" + primitives + R"(]}], "materials": [)" +
                      materials + R"(], "textures": [)" + textures + R"(], "images": [)" + images + "]");
  };
  int decoded = 0;
  const ImageDecoder decode = [&decoded](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
    decoded += most > 0 ? 1 : 0;
    return decode_plain(content, where, most);
  };
  const ScratchFolder scratch;
  const std::string refused =
      error_of(ErrorKind::bad_input, [&] { load_scene(scratch.write("b.gltf", text(broken)), {}, decode); });
  CHECK(refused.find("/images/16: it is cut off") != std::string::npos);
  CHECK(decoded == 0);
  const Scene scene = load_scene(scratch.write("g.gltf", text(good)), {}, decode);
  CHECK(scene.textures.size() == 1);
  CHECK(scene.materials.size() == 17);
  CHECK(decoded == 1);
}

TEST_CASE("broken geometry is named before broken pictures, and few pictures are decoded beside it") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  asset.accessor(std::vector<uint16_t>{0, 1, 2}, "SCALAR");
  asset.accessor(std::vector<uint16_t>{0, 1, 7}, "SCALAR");  // there is no vertex 7
  constexpr int kPictures = 64;
  std::string materials, textures, images, primitives;
  for (int i = 0; i < kPictures; ++i) {
    const std::string comma = i > 0 ? ", " : "", index = std::to_string(i),
                      content = "\x89PNG\r\n\x1a\n\2\2" + std::string(i >= 3 ? "broken" : "abcd");
    const int view = asset.view(std::vector<char>(content.begin(), content.end()));
    materials += comma + R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": )" + index + "}}}";
    textures += comma + R"({"source": )" + index + "}";
    images += comma + R"({"mimeType": "image/png", "bufferView": )" + std::to_string(view) + "}";
    primitives +=
        comma + R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": )" + index + "}";
  }
  const auto text = [&](const std::string& more_primitives) {
    return asset.gltf(R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" + primitives + more_primitives +
                      R"(]}], "materials": [)" + materials + R"(], "textures": [)" + textures + R"(], "images": [)" +
                      images + "]");
  };
  std::atomic<int> decoded = 0;
  const ImageDecoder decode = [&](std::span<const uint8_t> content, const std::string& where, uint64_t most) {
    if (most > 0) {
      ++decoded;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // geometry takes less
      if (content.size() > 14) throw Error(ErrorKind::bad_input, where, "it is broken", "a whole one");
    }
    return decode_plain(content, where, most);
  };
  const ScratchFolder scratch;
  const auto refused = [&](const std::string& more_primitives) {
    decoded = 0;
    return error_of(ErrorKind::bad_input,
                    [&] { load_scene(scratch.write("b.gltf", text(more_primitives)), {}, decode); });
  };
  CHECK(refused("").find("/images/3: it is broken") != std::string::npos);
  CHECK(decoded <= 8);  // that are decoded together
  CHECK(refused(R"(, {"attributes": {"POSITION": 0}, "indices": 3})").find("/primitives/64") != std::string::npos);
  CHECK(decoded < int(std::max(2u, 2 * std::thread::hardware_concurrency())));
}

TEST_CASE("a primitive that uses few vertices of a large accessor keeps these, its triangles and the bounds of all") {
  constexpr uint32_t kVertices = 10000, kPrimitives = 20;
  std::vector<float> positions, normals, uv;
  for (uint32_t v = 0; v < kVertices; ++v) {
    const float x = float(v % 100), y = float(v / 100), z = float(v * 37 % 101);
    positions.insert(positions.end(), {x, y, z});
    normals.insert(normals.end(), {0, 0, 1});
    uv.insert(uv.end(), {x / 128, y / 128});
  }
  Asset asset;
  asset.accessor(positions, "VEC3");
  asset.accessor(normals, "VEC3");
  asset.accessor(uv, "VEC2");
  std::vector<std::vector<uint32_t>> corners;
  std::string primitives;
  for (uint32_t i = 0; i < kPrimitives; ++i) {
    std::vector<uint32_t>& own = corners.emplace_back();
    for (uint32_t k = 0; k < 6; ++k) own.push_back((7919 * (i + 1) + 4001 * k * k) % kVertices);
    primitives += (i > 0 ? ", " : "") +
                  std::string(R"({"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": )") +
                  std::to_string(asset.accessor(own, "SCALAR")) + "}";
  }
  std::vector<uint32_t> many;
  for (uint32_t v = 0; v < 3000; ++v) many.push_back(3 * v);
  primitives += R"(, {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": )" +
                std::to_string(asset.accessor(many, "SCALAR")) + "}";
  const Scene scene =
      load_gltf(asset.gltf(R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" + primitives + "]}]"));
  REQUIRE(scene.meshes.size() == kPrimitives + 1);
  CHECK(scene.meshes.back().vertex_count() == kVertices);  // a third is used
  CHECK(scene.meshes.back().indices == many);
  for (uint32_t i = 0; i < kPrimitives; ++i) {
    const Mesh& mesh = scene.meshes[i];
    CHECK(mesh.vertex_count() <= 12);
    CHECK(mesh.normal[2] == std::vector<float>(mesh.vertex_count(), 1.0f));
    REQUIRE(mesh.indices.size() == corners[i].size());
    for (size_t k = 0; k < mesh.indices.size(); ++k) {
      const uint32_t before = corners[i][k], after = mesh.indices[k];
      for (size_t c = 0; c < 3; ++c) CHECK(mesh.position[c][after] == positions[3 * before + c]);
      for (size_t c = 0; c < 2; ++c) CHECK(mesh.uv[c][after] == uv[2 * before + c]);
    }
    Scene alone = scene;  // what it does not draw still bounds it, as it did with all vertices
    alone.instances = {scene.instances[i]};
    const Bounds bounds = bounds_of(alone), all = bounds_of(scene);
    CHECK(bounds.least == all.least);
    CHECK(bounds.radius == all.radius);
  }
}

TEST_CASE("channels that share a sampler read it once") {
  constexpr size_t kSteps = 20000, kNodes = 50;
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(zeros(kSteps, "SCALAR"));
  asset.accessor(zeros(kSteps, "VEC3"));
  const auto text = [&](const std::string& path, const std::string& output) {
    std::string channels;
    for (size_t i = 0; i < kNodes; ++i)
      channels += (i > 0 ? ", " : "") + std::string(R"({"sampler": 0, "target": {"node": )") + std::to_string(i) +
                  R"(, "path": ")" + path + R"("}})";
    return asset.gltf(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]}]}],
      "nodes": [)" + repeated(R"({"mesh": 0})", kNodes) +
                      R"(], "animations": [{"samplers": [{"input": 1, "output": )" + output + R"(}], "channels": [)" +
                      channels + "]}]");
  };
  SceneLimits limits;
  limits.geometry_bytes = 1000000;  // once: 640,000 bytes of translations, and of weights 320,000
  const Scene moved = load_gltf(text("translation", "2"), limits);
  REQUIRE(moved.timeline.node_motions.size() == kNodes);
  CHECK(moved.timeline.node_motions.back().motion.position->times == std::vector<double>{0.0});
  const Scene weighed = load_gltf(text("weights", "1"), limits);
  REQUIRE(weighed.timeline.posed.size() == kNodes);
  CHECK(weighed.timeline.posed.back().motion->values == std::vector<double>{0.0});
}

}  // namespace
}  // namespace trueshade
