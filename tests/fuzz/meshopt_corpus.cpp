// meshopt_corpus FOLDER: writes glTF files whose data meshoptimizer has packed, a file for each mode, stride and filter
// of EXT_meshopt_compression. The corpora hold what it wrote with Debian's version 0.18.
#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tests/scenes/gltf/encode_exponents.h"

namespace {

using Bytes = std::vector<uint8_t>;

std::string base64(const Bytes& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

/// A document in the making: a packed view each, and accessors of them.
struct Packed {
  Bytes data;
  size_t unpacked = 0;
  std::string views, accessors;

  void view(const Bytes& packed, size_t count, size_t stride, const char* mode, const char* filter = "NONE") {
    data.resize((data.size() + 3) / 4 * 4);
    const auto number = [](size_t value) { return std::to_string(value); };
    views += (views.empty() ? "" : ",") + ("{\"buffer\":1,\"byteOffset\":" + number(unpacked)) +
             ",\"byteLength\":" + number(count * stride) +
             (mode == std::string("ATTRIBUTES") ? ",\"byteStride\":" + number(stride) : "") +
             ",\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":" + number(data.size()) +
             ",\"byteLength\":" + number(packed.size()) + ",\"byteStride\":" + number(stride) +
             ",\"count\":" + number(count) + ",\"mode\":\"" + mode + "\",\"filter\":\"" + filter + "\"}}}";
    data.insert(data.end(), packed.begin(), packed.end());
    unpacked += (count * stride + 3) / 4 * 4;
  }

  void vertices(const void* values, size_t count, size_t stride, const char* filter = "NONE") {
    Bytes out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values, count, stride));
    view(out, count, stride, "ATTRIBUTES", filter);
  }

  void accessor(int of_view, int type, size_t count, const char* shape, bool normalized = false) {
    accessors += (accessors.empty() ? "{\"bufferView\":" : ",{\"bufferView\":") + std::to_string(of_view) +
                 ",\"componentType\":" + std::to_string(type) + ",\"count\":" + std::to_string(count) + ",\"type\":\"" +
                 shape + (normalized ? "\",\"normalized\":true}" : "\"}");
  }

  void write(const std::string& path, const std::string& attributes, const std::string& node = "") const {
    std::ofstream(path) << R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_meshopt_compression",)"
                        << R"("KHR_mesh_quantization","EXT_mesh_gpu_instancing"],"extensionsRequired":)"
                        << R"(["EXT_meshopt_compression","KHR_mesh_quantization"],"buffers":[{"uri":")"
                        << "data:application/octet-stream;base64," << base64(data)
                        << "\",\"byteLength\":" << data.size() << "},{\"byteLength\":" << unpacked
                        << R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],"bufferViews":[)" << views
                        << "],\"accessors\":[" << accessors
                        << R"(],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" << node
                        << R"(}],"meshes":[{"primitives":[{"attributes":{)" << attributes << "}]}]}";
  }
};

/// Positions of a strip, and directions around it.
std::vector<float> positions(size_t count) {
  std::vector<float> out;
  for (size_t i = 0; i < count; ++i) out.insert(out.end(), {float(i / 2), float(i % 2), 0.25f * float(i)});
  return out;
}

std::vector<float> turns(size_t count) {
  std::vector<float> out;
  for (size_t i = 0; i < count; ++i) {
    const float a = 0.7f * float(i);
    out.insert(out.end(), {std::sin(a) * 0.6f, std::sin(a) * 0.8f, 0.0f, std::cos(a)});
  }
  return out;
}

constexpr size_t kCount = 6;

Packed begun() {
  Packed file;
  file.vertices(positions(kCount).data(), kCount, 12);
  file.accessor(0, 5126, kCount, "VEC3");
  return file;
}

void write_indexed(const std::string& folder, bool triangles, size_t stride) {
  Packed file = begun();
  const std::vector<uint32_t> indices{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};
  Bytes out(triangles ? meshopt_encodeIndexBufferBound(12, kCount) : meshopt_encodeIndexSequenceBound(12, kCount));
  out.resize(triangles ? meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), 12)
                       : meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), 12));
  file.view(out, 12, stride, triangles ? "TRIANGLES" : "INDICES");
  file.accessor(1, stride == 2 ? 5123 : 5125, 12, "SCALAR");
  file.write(folder + "/meshopt-" + (triangles ? "triangles-" : "indices-") + std::to_string(stride),
             R"("POSITION":0},"indices":1)");
}

void write_directions(const std::string& folder, int bits) {
  Packed file = begun();
  const size_t stride = bits == 8 ? 4 : 8;
  Bytes filtered(kCount * stride);
  meshopt_encodeFilterOct(filtered.data(), kCount, stride, bits, turns(kCount).data());
  file.vertices(filtered.data(), kCount, stride, "OCTAHEDRAL");
  file.accessor(1, bits == 8 ? 5120 : 5122, kCount, "VEC3", true);
  file.write(folder + "/meshopt-octahedral-" + std::to_string(bits), R"("POSITION":0,"NORMAL":1})");
}

void write_quaternions(const std::string& folder) {
  Packed file = begun();
  Bytes filtered(kCount * 8);
  meshopt_encodeFilterQuat(filtered.data(), kCount, 8, 16, turns(kCount).data());
  file.vertices(filtered.data(), kCount, 8, "QUATERNION");
  file.accessor(1, 5122, kCount, "VEC4", true);
  file.write(folder + "/meshopt-quaternion", R"("POSITION":0})",
             R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"ROTATION":1}}})");
}

void write_exponents(const std::string& folder) {
  Packed file;
  std::vector<uint32_t> filtered(kCount * 3);
  trueshade::testing::encode_exponents(filtered.data(), kCount, 12, 15, positions(kCount).data());
  file.vertices(filtered.data(), kCount, 12, "EXPONENTIAL");
  file.accessor(0, 5126, kCount, "VEC3");
  file.write(folder + "/meshopt-exponential", R"("POSITION":0})");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "meshopt_corpus FOLDER\n"), 2;
  const std::string folder = arguments[1];
  for (const bool triangles : {false, true})
    for (const size_t stride : {size_t(2), size_t(4)}) write_indexed(folder, triangles, stride);
  for (const int bits : {8, 16}) write_directions(folder, bits);
  write_quaternions(folder);
  write_exponents(folder);
  return 0;
}
