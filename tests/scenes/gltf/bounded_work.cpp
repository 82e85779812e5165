#include <ctime>

#include "../expect_error.h"
#include "asset.h"

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

TEST_CASE("posed meshes are counted as geometry, with the weights of their targets") {
  Asset asset;
  asset.accessor(zeros(3, "VEC3"));
  const auto text = [&](size_t nodes) {
    return asset.gltf(R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "targets": [)" +
                      repeated(R"({"POSITION": 0})", 1000) + R"(]}]}], "nodes": [)" +
                      repeated(R"({"mesh": 0})", nodes) + "]");
  };
  SceneLimits limits;
  limits.geometry_bytes = 200000;
  CHECK(load_gltf(text(4), limits).meshes.size() == 4);
  CHECK_STARTS_WITH(gltf_refusal(text(100), ErrorKind::limit, limits),
                    ": /meshes/0/primitives/0: with these 8");  // 8,000 bytes of weights, and the mesh
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

}  // namespace
}  // namespace trueshade
