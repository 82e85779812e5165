#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {

/// A small glTF document in the making: data are appended to one buffer, and the rest is said in JSON.
class Asset {
 public:
  /// Index of a view of these bytes, which start on a multiple of 8. `more` is JSON, such as `"byteStride": 16`.
  template <typename T>
  int view(const std::vector<T>& values, const std::string& more = "") {
    const size_t bytes = values.size() * sizeof(T), offset = (data_.size() + 7) / 8 * 8;
    data_.resize(offset + bytes);
    std::memcpy(data_.data() + offset, values.data(), bytes);
    add(views_, R"({"buffer": 0, "byteOffset": )" + std::to_string(offset) + R"(, "byteLength": )" +
                    std::to_string(bytes) + (more.empty() ? "" : ", " + more) + "}");
    return view_count_++;
  }

  /// Index of an accessor: `what` is JSON, such as `"bufferView": 0, "componentType": 5126, "count": 3, "type":
  /// "VEC3"`.
  int accessor(const std::string& what) {
    add(accessors_, "{" + what + "}");
    return accessor_count_++;
  }

  /// Of values in a view of their own. `count` elements of `type`.
  template <typename T>
  int accessor(const std::vector<T>& values, const std::string& type, const std::string& more = "") {
    const size_t each = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type[3] - '0');
    return accessor(R"("bufferView": )" + std::to_string(view(values)) + R"(, "componentType": )" +
                    std::to_string(component_type(T())) + R"(, "count": )" + std::to_string(values.size() / each) +
                    R"(, "type": ")" + type + '"' + (more.empty() ? "" : ", " + more));
  }

  /// The document as .gltf with its buffer as a data URI, or named `uri`. `rest` is JSON of further lists.
  std::string gltf(const std::string& rest, const std::string& uri = "") const {
    return document(rest, R"("uri": ")" + (uri.empty() ? data_uri() : uri) + R"(", )");
  }
  std::string glb(const std::string& rest) const;
  std::string data() const { return std::string(data_.begin(), data_.end()); }
  std::string data_uri() const;

 private:
  static int component_type(int8_t) { return 5120; }
  static int component_type(uint8_t) { return 5121; }
  static int component_type(int16_t) { return 5122; }
  static int component_type(uint16_t) { return 5123; }
  static int component_type(uint32_t) { return 5125; }
  static int component_type(float) { return 5126; }
  static void add(std::string& list, const std::string& element) { list += (list.empty() ? "" : ", ") + element; }
  std::string document(const std::string& rest, const std::string& uri) const;

  std::vector<char> data_;
  std::string views_, accessors_;
  int view_count_ = 0, accessor_count_ = 0;
};

/// Base64 with padding.
std::string base64(std::string_view bytes);

/// A .glb file of a JSON text and perhaps a chunk BIN.
std::string glb_of(std::string json, std::string bin);

/// Loads a document that stands alone in a folder, under a name that ends as `ending` says.
Scene load_gltf(const std::string& content, const SceneLimits& limits = {}, const std::string& ending = ".gltf");

/// The error that loading it gives, from the file's name on.
std::string gltf_refusal(const std::string& content, ErrorKind kind = ErrorKind::bad_input,
                         const SceneLimits& limits = {}, const std::string& ending = ".gltf");

/// The positions of a triangle.
inline const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

/// A scene with one node that draws a mesh of one primitive. `primitive` is JSON of the primitive's members.
inline std::string one_primitive(const std::string& primitive, const std::string& node = "",
                                 const std::string& more = "") {
  return R"("scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)" + (node.empty() ? "" : ", " + node) +
         R"(}], "meshes": [{"primitives": [{)" + primitive + "}]}]" + (more.empty() ? "" : ", " + more);
}

/// A decoder of pictures: behind PNG's first 8 bytes stand width and height, a byte each, and RGBA codes.
Image decode_plain(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes);

/// A picture of decode_plain(): PNG's first bytes, the sides, and one texel that fills it.
inline std::string plain_picture(int width, int height, const char* texel = "\x10\x20\x30\x40") {
  return std::string("\x89PNG\r\n\x1a\n") + char(width) + char(height) + texel;
}

}  // namespace trueshade
