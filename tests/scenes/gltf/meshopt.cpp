#include "scenes/files/gltf/meshopt.h"

#include <meshoptimizer.h>

#include <cmath>

#include "../expect_error.h"
#include "asset.h"
#include "encode_exponents.h"

namespace trueshade {
namespace {

using gltf::Packing;

template <typename T>
std::vector<uint8_t> packed_vertices(const std::vector<T>& values, size_t count, size_t stride) {
  std::vector<uint8_t> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return out;
}

Packing packing_of(size_t count, uint32_t stride, Packing::Mode mode, Packing::Filter filter = Packing::Filter::none) {
  Packing packing;
  packing.count = count, packing.stride = stride, packing.mode = mode, packing.filter = filter;
  return packing;
}

template <typename T>
std::vector<T> unpacked(const Packing& packing, const std::vector<uint8_t>& bytes) {
  const Bytes out = gltf::unpacked_by_meshopt(packing, bytes, "here");
  std::vector<T> values(out.size() / sizeof(T));
  std::memcpy(values.data(), out.data(), out.size());
  return values;
}

TEST_CASE("a packed file is the unpacked one") {
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5f};
  const std::vector<uint16_t> indices{0, 1, 2, 2, 1, 3};
  Asset plain, packed;
  plain.accessor(positions, "VEC3");
  plain.accessor(indices, "SCALAR");
  const std::string rest = one_primitive(R"("attributes": {"POSITION": 0}, "indices": 1)");
  const std::vector<uint8_t> vertices = packed_vertices(positions, 4, 12);
  std::vector<uint8_t> triangles(meshopt_encodeIndexBufferBound(6, 4));
  const std::vector<uint32_t> wide(indices.begin(), indices.end());
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), wide.data(), 6));
  const int v = packed.view(vertices), t = packed.view(triangles);
  CHECK(v == 0);
  CHECK(t == 1);
  // Two more views stand for the unpacked data, in a buffer without data.
  const auto document = [&](const std::string& vertex_bytes) {
    const std::string data = packed.data();
    const size_t second = (vertices.size() + 7) / 8 * 8;
    return R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_meshopt_compression"], "extensionsRequired": ["EXT_meshopt_compression"],
      "buffers": [{"uri": ")" +
           packed.data_uri() + R"(", "byteLength": )" + std::to_string(data.size()) + R"(},
                  {"byteLength": 60, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}],
      "bufferViews": [{"buffer": 1, "byteLength": )" +
           vertex_bytes + R"(, "byteStride": 12, "extensions": {"EXT_meshopt_compression":
                        {"buffer": 0, "byteLength": )" +
           std::to_string(vertices.size()) + R"(, "byteStride": 12, "count": 4, "mode": "ATTRIBUTES"}}},
                      {"buffer": 1, "byteOffset": 48, "byteLength": 12, "extensions": {"EXT_meshopt_compression":
                        {"buffer": 0, "byteOffset": )" +
           std::to_string(second) + R"(, "byteLength": )" + std::to_string(triangles.size()) +
           R"(, "byteStride": 2, "count": 6, "mode": "TRIANGLES"}}}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}], )" +
           rest + "}";
  };
  CHECK(scene_hash(load_gltf(document("48"))) == scene_hash(load_gltf(plain.gltf(rest))));
  CHECK_STARTS_WITH(gltf_refusal(document("47")),
                    ": /bufferViews/0/extensions/EXT_meshopt_compression: count times byteStride");
}

TEST_CASE("index sequences are unpacked, and broken streams refused") {
  const std::vector<uint32_t> list{7, 3, 900, 2, 2, 1};
  std::vector<uint8_t> bytes(meshopt_encodeIndexSequenceBound(6, 1000));
  bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), list.data(), 6));
  CHECK(unpacked<uint32_t>(packing_of(6, 4, Packing::Mode::indices), bytes) == list);
  CHECK(unpacked<uint16_t>(packing_of(6, 2, Packing::Mode::indices), bytes) ==
        std::vector<uint16_t>{7, 3, 900, 2, 2, 1});
  const auto refused = [&](const Packing& packing, const std::vector<uint8_t>& stream) {
    return error_of(ErrorKind::bad_input, [&] { gltf::unpacked_by_meshopt(packing, stream, "here"); });
  };
  for (size_t cut = 0; cut < bytes.size(); ++cut)
    CHECK_STARTS_WITH(
        refused(packing_of(6, 4, Packing::Mode::indices), {bytes.begin(), bytes.begin() + ptrdiff_t(cut)}),
        "here: the packed data are ");
  CHECK_STARTS_WITH(refused(packing_of(6, 4, Packing::Mode::triangles), bytes), "here: the packed data are broken");
  CHECK_STARTS_WITH(refused(packing_of(6, 4, Packing::Mode::attributes), bytes), "here: the packed data are broken");
  CHECK_STARTS_WITH(refused(packing_of(size_t(1) << 40, 256, Packing::Mode::attributes), bytes),
                    "here: the packed data are too short");
  CHECK_STARTS_WITH(refused(packing_of(size_t(3) << 40, 4, Packing::Mode::triangles), bytes),
                    "here: the packed data are too short");
}

TEST_CASE("octahedral directions come back within a code of what was packed") {
  for (const bool wide : {false, true}) {
    const size_t stride = wide ? 8 : 4;
    const double most = wide ? 32767.0 : 127.0;
    std::vector<float> directions;
    for (int i = 0; i < 200; ++i) {
      const double a = 0.37 * i, z = -1.0 + i / 99.5, r = std::sqrt(std::max(0.0, 1.0 - z * z));
      directions.insert(directions.end(), {float(r * std::cos(a)), float(r * std::sin(a)), float(z), 1.0f});
    }
    std::vector<uint8_t> filtered(200 * stride);
    meshopt_encodeFilterOct(filtered.data(), 200, stride, wide ? 16 : 8, directions.data());
    const Bytes out = gltf::unpacked_by_meshopt(
        packing_of(200, uint32_t(stride), Packing::Mode::attributes, Packing::Filter::octahedral),
        packed_vertices(filtered, 200, stride), "here");
    for (size_t i = 0; i < 200; ++i)
      for (size_t k = 0; k < 3; ++k) {
        int16_t code = 0;
        if (wide)
          std::memcpy(&code, out.data() + i * 8 + 2 * k, 2);
        else
          code = int8_t(out[i * 4 + k]);
        CHECK(std::fabs(double(code) / most - double(directions[4 * i + k])) <= (wide ? 1e-4 : 0.02));
      }
  }
}

TEST_CASE("quaternions and exponents come back as they were packed") {
  std::vector<float> turns;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.1 * i, b = 0.07 * i;
    turns.insert(turns.end(), {float(std::sin(a) * std::cos(b)), float(std::cos(a) * std::cos(b)),
                               float(std::sin(b) * 0.6), float(std::sin(b) * 0.8)});
  }
  std::vector<uint8_t> filtered(800);
  meshopt_encodeFilterQuat(filtered.data(), 100, 8, 16, turns.data());
  const auto codes = unpacked<int16_t>(packing_of(100, 8, Packing::Mode::attributes, Packing::Filter::quaternion),
                                       packed_vertices(filtered, 100, 8));
  for (size_t i = 0; i < 100; ++i) {
    double same = 0.0;
    for (size_t k = 0; k < 4; ++k) same += double(codes[4 * i + k]) / 32767.0 * double(turns[4 * i + k]);
    CHECK(std::fabs(std::fabs(same) - 1.0) < 1e-4);
  }
  const std::vector<float> numbers{1.5f, -0.25f, 1000.0f, 0.0f, 3e-5f, -7.0f, 123456.0f, 1e10f};
  std::vector<uint32_t> exponents(8);
  testing::encode_exponents(exponents.data(), 4, 8, 15, numbers.data());
  const auto floats = unpacked<float>(packing_of(4, 8, Packing::Mode::attributes, Packing::Filter::exponential),
                                      packed_vertices(exponents, 4, 8));
  for (size_t i = 0; i < 8; ++i) {
    const float largest = std::max(std::fabs(numbers[i / 2 * 2]), std::fabs(numbers[i / 2 * 2 + 1]));
    CHECK(std::fabs(floats[i] - numbers[i]) <= largest * 1e-3f);
  }
}

TEST_CASE("filtered values beyond their type become the largest or the least") {
  const std::vector<int16_t> wrong{32767, -32768, 32767, 3, 0, 0, 0, 3};  // a scale of 3 stands for 1
  const auto codes = unpacked<int16_t>(packing_of(2, 8, Packing::Mode::attributes, Packing::Filter::quaternion),
                                       packed_vertices(wrong, 2, 8));
  CHECK(codes == std::vector<int16_t>{32767, -32768, 32767, 0, 0, 0, 0, 32767});
}

}  // namespace
}  // namespace trueshade
