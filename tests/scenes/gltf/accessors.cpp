#include <cmath>
#include <limits>

#include "../expect_error.h"
#include "asset.h"

namespace trueshade {
namespace {

const std::string kQuantized = R"("extensionsUsed": ["KHR_mesh_quantization"], )";

std::string positions(int accessor, const std::string& more = "") {
  return R"("attributes": {"POSITION": )" + std::to_string(accessor) + more + "}";
}

/// The positions that a triangle of values of a type has.
template <typename T>
std::vector<float> loaded_positions(const std::vector<T>& values, bool normalized) {
  Asset asset;
  asset.accessor(values, "VEC3", normalized ? R"("normalized": true)" : "");
  const Scene scene = load_gltf(asset.gltf(kQuantized + one_primitive(positions(0))));
  std::vector<float> out;
  for (size_t v = 0; v < 3; ++v)
    for (size_t k = 0; k < 3; ++k) out.push_back(scene.meshes.at(0).position[k][v]);
  return out;
}

/// Every code of a type as the format's formula has it: c, or max(c / most, -1), in f64 and rounded once.
template <typename T>
void check_all_codes() {
  const int64_t least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
  std::vector<T> codes;
  for (int64_t c = least; c <= most; ++c) codes.push_back(T(c));
  while (codes.size() % 9 != 0) codes.push_back(T(1));
  for (size_t i = 0; i < codes.size(); i += sizeof(T) == 1 ? 9 : 9 * 97) {
    const std::vector<T> nine(codes.begin() + ptrdiff_t(i), codes.begin() + ptrdiff_t(i + 9));
    const std::vector<float> plain = loaded_positions(nine, false), normalized = loaded_positions(nine, true);
    for (size_t k = 0; k < 9; ++k) {
      REQUIRE(plain[k] == float(nine[k]));
      REQUIRE(normalized[k] == float(std::max(double(nine[k]) / double(most), -1.0)));
    }
  }
}

TEST_CASE("integers of every component type are read, normalized and not") {
  check_all_codes<int8_t>();
  check_all_codes<uint8_t>();
  check_all_codes<int16_t>();
  check_all_codes<uint16_t>();
  const std::vector<float> floats{0, -0.0f, 1e-40f, 1.5f, -1e15f, 3, 4, 5, 0.1f};
  CHECK(loaded_positions(floats, false) == floats);
}

TEST_CASE("indices of every width draw the same") {
  const auto hash = [](const auto& indices) {
    Asset asset;
    asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
    asset.accessor(indices, "SCALAR");
    return scene_hash(load_gltf(asset.gltf(one_primitive(positions(0) + R"(, "indices": 1)"))));
  };
  const std::string expected = hash(std::vector<uint8_t>{0, 1, 2, 1, 3, 2});
  CHECK(hash(std::vector<uint16_t>{0, 1, 2, 1, 3, 2}) == expected);
  CHECK(hash(std::vector<uint32_t>{0, 1, 2, 1, 3, 2}) == expected);
}

TEST_CASE("interleaved and separate data are the same") {
  Asset together, apart;
  const std::string rest = one_primitive(R"("attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2})");
  const std::vector<float> normals{0, 0, 1, 0, 1, 0, 1, 0, 0}, uvs{0, 0, 0.5f, 0, 0, 0.25f};
  apart.accessor(kTriangle, "VEC3");
  apart.accessor(normals, "VEC3");
  apart.accessor(uvs, "VEC2");
  std::vector<float> mixed;
  for (size_t v = 0; v < 3; ++v) {
    mixed.insert(mixed.end(), kTriangle.begin() + ptrdiff_t(3 * v), kTriangle.begin() + ptrdiff_t(3 * v + 3));
    mixed.insert(mixed.end(), normals.begin() + ptrdiff_t(3 * v), normals.begin() + ptrdiff_t(3 * v + 3));
    mixed.insert(mixed.end(), uvs.begin() + ptrdiff_t(2 * v), uvs.begin() + ptrdiff_t(2 * v + 2));
  }
  together.view(mixed, R"("byteStride": 32)");
  const std::string start = R"("bufferView": 0, "componentType": 5126, "count": 3, "byteOffset": )";
  together.accessor(start + R"(0, "type": "VEC3")");
  together.accessor(start + R"(12, "type": "VEC3")");
  together.accessor(start + R"(24, "type": "VEC2")");
  CHECK(scene_hash(load_gltf(together.gltf(rest))) == scene_hash(load_gltf(apart.gltf(rest))));
}

TEST_CASE("sparse accessors are the dense ones with elements replaced, or zeros without a view") {
  const std::string rest = one_primitive(positions(0));
  Asset dense, over_zeros;
  dense.accessor(kTriangle, "VEC3");
  const std::string expected = scene_hash(load_gltf(dense.gltf(rest)));
  const int indices = over_zeros.view(std::vector<uint8_t>{1, 2}),
            values = over_zeros.view(std::vector<float>{1, 0, 0, 0, 1, 0});
  const auto sparse = [](int index_view, int type, int value_view) {
    return R"("sparse": {"count": 2, "indices": {"bufferView": )" + std::to_string(index_view) +
           R"(, "componentType": )" + std::to_string(type) + R"(}, "values": {"bufferView": )" +
           std::to_string(value_view) + "}}";
  };
  const std::string zeros = R"("componentType": 5126, "count": 3, "type": "VEC3", )";
  over_zeros.accessor(zeros + sparse(indices, 5121, values));
  CHECK(scene_hash(load_gltf(over_zeros.gltf(rest))) == expected);

  Asset over_others;
  const int view = over_others.view(std::vector<float>{0, 0, 0, 7, 7, 7, 8, 8, 8});
  const int wide = over_others.view(std::vector<uint32_t>{1, 2}),
            moved = over_others.view(std::vector<float>{1, 0, 0, 0, 1, 0});
  over_others.accessor(R"("bufferView": )" + std::to_string(view) + ", " + zeros + sparse(wide, 5125, moved));
  CHECK(scene_hash(load_gltf(over_others.gltf(rest))) == expected);

  const auto refused = [&](const std::vector<uint16_t>& list, const std::string& from = "\"count\": 2",
                           const std::string& to = "\"count\": 2") {
    Asset asset;
    const int i = asset.view(list), v = asset.view(std::vector<float>{1, 0, 0, 0, 1, 0});
    std::string text = sparse(i, 5123, v);
    if (const size_t found = text.find(from); found != std::string::npos) text.replace(found, from.size(), to);
    asset.accessor(zeros + text);
    return gltf_refusal(asset.gltf(rest));
  };
  CHECK_STARTS_WITH(refused({2, 1}), ": /accessors/0/sparse/indices: index 1 is beyond the elements or not above");
  CHECK_STARTS_WITH(refused({1, 1}), ": /accessors/0/sparse/indices: index 1 is beyond the elements or not above");
  CHECK_STARTS_WITH(refused({1, 3}), ": /accessors/0/sparse/indices: index 3 is beyond the elements");
  CHECK_STARTS_WITH(refused({1, 2}, "\"count\": 2", "\"count\": 4"),
                    ": /accessors/0/sparse: there are more sparse elements");
  CHECK_STARTS_WITH(refused({1, 2}, "\"count\": 2", "\"count\": 3"),
                    ": /accessors/0/sparse/indices: 3 elements from byte 0 on do not fit");
  CHECK_STARTS_WITH(refused({1, 2}, "5123", "5122"), ": /accessors/0/sparse/indices/componentType: sparse indices are");
}

TEST_CASE("accessors lie in their views and views in their buffers, in 64 bits") {
  const auto refused = [](const std::string& view, const std::string& accessor) {
    return gltf_refusal(
        R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 100}], "bufferViews": [{"buffer": 0, )" + view +
        R"(}], "accessors": [{)" + accessor + "}]}");
  };
  const std::string view = R"("byteLength": 36)",
                    floats = R"("componentType": 5126, "type": "VEC3", "bufferView": 0, )";
  const auto fits = [&](const std::string& v, const std::string& accessor) {
    return load_gltf(
               R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 100}], "bufferViews": [{"buffer": 0, )" + v +
               R"(}], "accessors": [{)" + accessor + "}]}")
        .meshes.empty();
  };
  CHECK(fits(view, floats + R"("count": 3)"));
  CHECK(fits(R"("byteLength": 44, "byteStride": 16)", floats + R"("count": 3)"));  // nothing behind the last
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 4)"),
                    ": /accessors/0: 4 elements from byte 0 on do not fit into the view of 36");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 3, "byteOffset": 4)"),
                    ": /accessors/0: 3 elements from byte 4 on do not fit");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 1, "byteOffset": 40)"),
                    ": /accessors/0: 1 elements from byte 40 on");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 1, "byteOffset": 2)"),
                    ": /accessors/0: the data do not start on a multiple of 4");
  CHECK_STARTS_WITH(refused(view + R"(, "byteOffset": 2)", floats + R"("count": 1)"),
                    ": /accessors/0: the data do not start");
  CHECK_STARTS_WITH(refused(view + R"(, "byteStride": 8)", floats + R"("count": 1)"),
                    ": /accessors/0: the view's stride of 8 is below");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 9007199254740992)"),
                    ": /accessors/0: 9007199254740992 elements");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 768614336404564651)"), ": /accessors/0/count: found");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 0)"), ": /accessors/0/count: found 0");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 1.5)"), ": /accessors/0/count: found 1.5");
  CHECK_STARTS_WITH(refused(view, R"("componentType": 5124, "type": "VEC3", "count": 1)"),
                    ": /accessors/0/componentType: component type 5124");
  CHECK_STARTS_WITH(refused(view, R"("componentType": 5130, "type": "VEC3", "count": 1)"),
                    ": /accessors/0/componentType: found 5130");
  CHECK_STARTS_WITH(refused(view, R"("componentType": 5126, "type": "VEC3", "count": 1, "byteOffset": 4)"),
                    ": /accessors/0/byteOffset: an accessor without a bufferView");
  CHECK_STARTS_WITH(refused(view, floats + R"("count": 1, "normalized": true)"),
                    ": /accessors/0/componentType: floats and 32-bit integers cannot");
  CHECK_STARTS_WITH(refused(view, R"("componentType": 5126, "type": "VEC3", "count": 1, "bufferView": 1)"),
                    ": /accessors/0/bufferView: there is no buffer view 1 (an index below 1)");
  CHECK_STARTS_WITH(
      refused(view, R"("componentType": 5121, "type": "MAT2", "count": 1, "bufferView": 0, "byteOffset": 2)"),
      ": /accessors/0: a matrix is not aligned");
  CHECK_STARTS_WITH(refused(R"("byteLength": 101)", floats + R"("count": 1)"),
                    ": /bufferViews/0: the bytes from 0 to 101 do not fit into buffer 0 of 100");
  CHECK_STARTS_WITH(
      refused(R"("byteLength": 9007199254740991, "byteOffset": 9007199254740991)", floats + R"("count": 1)"),
      ": /bufferViews/0: the bytes from 9007199254740991");
  CHECK_STARTS_WITH(refused(view + R"(, "byteStride": 6)", floats + R"("count": 1)"),
                    ": /bufferViews/0/byteStride: the stride is no multiple of 4");
  CHECK_STARTS_WITH(refused(view + R"(, "byteStride": 256)", floats + R"("count": 1)"),
                    ": /bufferViews/0/byteStride: the stride is 256");
  CHECK_STARTS_WITH(refused(view + R"(, "byteStride": 40)", floats + R"("count": 1)"),
                    ": /bufferViews/0/byteStride: the stride is over");
  CHECK_STARTS_WITH(refused(view + R"(, "byteStride": 12, "target": 34963)", floats + R"("count": 1)"),
                    ": /bufferViews/0/byteStride: a view of indices");
  CHECK_STARTS_WITH(refused(view + R"(, "target": 1)", floats + R"("count": 1)"), ": /bufferViews/0/target: found 1");
}

TEST_CASE("an accessor without data is zeros, and a huge one is refused before memory is taken") {
  const auto document = [](const std::string& count) {
    return R"({"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "type": "VEC3", "count": )" + count +
           "}], " + one_primitive(positions(0)) + "}";
  };
  const Scene scene = load_gltf(document("3"));
  CHECK(scene.meshes.at(0).position[1] == std::vector<float>(3, 0.0f));
  CHECK_STARTS_WITH(gltf_refusal(document("4294967295")),
                    ": /meshes/0/primitives/0/attributes/POSITION: 4294967295 vertices");
  CHECK_STARTS_WITH(gltf_refusal(document("4000000000"), ErrorKind::limit),
                    ": /accessors/0: with these 16000000000 bytes");
  SceneLimits limits;
  limits.geometry_bytes = 100;
  CHECK_STARTS_WITH(gltf_refusal(document("9"), ErrorKind::limit, limits),
                    ": /accessors/0: with these 36 bytes the geometry is over the limit (at most 100 bytes in all");
}

TEST_CASE("numbers that are not finite are refused where they are drawn") {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::nanf(""), 2e18f}) {
    Asset asset;
    asset.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, bad, 0}, "VEC3");
    CHECK_STARTS_WITH(gltf_refusal(asset.gltf(one_primitive(positions(0)))), ": /accessors/0: element 2 is not finite");
  }
}

TEST_CASE("types of accessors are those that the attribute allows") {
  const auto refused = [](const std::string& attribute, const std::string& type, const std::string& shape,
                          const std::string& more = "") {
    return gltf_refusal(R"({"asset": {"version": "2.0"}, "accessors": [{"componentType": )" + type + R"(, "type": ")" +
                        shape + R"(", "count": 3)" + more + "}], " +
                        one_primitive(R"("attributes": {")" + attribute + R"(": 0})") + "}");
  };
  for (const char* attribute : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0", "JOINTS_0", "WEIGHTS_0"}) {
    const std::string start = ": /meshes/0/primitives/0/attributes/" + std::string(attribute) + ": the accessor's type";
    CHECK_STARTS_WITH(refused(attribute, "5125", "VEC4"), start);
    CHECK_STARTS_WITH(refused(attribute, "5126", "SCALAR"), start);
    CHECK_STARTS_WITH(refused(attribute, "5120", "VEC3"), start);
  }
  CHECK_STARTS_WITH(refused("POSITION", "5123", "VEC3"),
                    ": /meshes/0/primitives/0/attributes/POSITION: the accessor's");
  for (const char* name : {"UNKNOWN", "TEXCOORD", "TEXCOORD_", "TEXCOORD_01", "TEXCOORD_a", "POSITION_0", "COLOR_9999"})
    CHECK_STARTS_WITH(refused(name, "5126", "VEC3"),
                      ": /meshes/0/primitives/0/attributes/" + std::string(name) + ": this attribute is not in glTF");
  CHECK_STARTS_WITH(refused("JOINTS_0", "5121", "VEC4"),
                    ": /meshes/0/primitives/0/attributes: there are not as many JOINTS as WEIGHTS");
  CHECK_STARTS_WITH(refused("POSITION", "5126", "NotaVEC3"),
                    ": /meshes/0/primitives/0/attributes/POSITION: the accessor's");
}

}  // namespace
}  // namespace trueshade
