#include "asset.h"

#include "../expect_error.h"

namespace trueshade {

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string glb_of(std::string json, std::string bin) {
  const auto word = [](size_t value) {
    std::string bytes(4, '\0');
    const uint32_t narrow = uint32_t(value);
    std::memcpy(bytes.data(), &narrow, 4);
    return bytes;
  };
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bin.resize((bin.size() + 3) / 4 * 4, '\0');
  const size_t all = 12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size());
  std::string out = "glTF" + word(2) + word(all) + word(json.size()) + "JSON" + json;
  if (!bin.empty()) out += word(bin.size()) + std::string("BIN\0", 4) + bin;
  return out;
}

std::string Asset::data_uri() const { return "data:application/octet-stream;base64," + base64(data()); }

std::string Asset::glb(const std::string& rest) const { return glb_of(document(rest, ""), data()); }

std::string Asset::document(const std::string& rest, const std::string& uri) const {
  std::string text = R"({"asset": {"version": "2.0"})";
  if (!data_.empty()) text += R"(, "buffers": [{)" + uri + R"("byteLength": )" + std::to_string(data_.size()) + "}]";
  if (!views_.empty()) text += R"(, "bufferViews": [)" + views_ + "]";
  if (!accessors_.empty()) text += R"(, "accessors": [)" + accessors_ + "]";
  return text + (rest.empty() ? "" : ", " + rest) + "}";
}

Scene load_gltf(const std::string& content, const SceneLimits& limits, const std::string& ending) {
  const ScratchFolder scratch;
  return load_scene(scratch.write("a" + ending, content), limits, decode_plain);
}

std::string gltf_refusal(const std::string& content, ErrorKind kind, const SceneLimits& limits,
                         const std::string& ending) {
  const std::string message = error_of(kind, [&] { load_gltf(content, limits, ending); });
  const size_t name = message.find("a" + ending);
  return name == std::string::npos ? message : message.substr(name + 1 + ending.size());
}

Image decode_plain(std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
  if (content.size() < 10) throw Error(ErrorKind::bad_input, where, "it is cut off", "write it again");
  Image image(content[8], content[9], Format::rgba8);
  if (image.texels.size() > most_bytes) throw Error(ErrorKind::limit, where, "too large", "a smaller one");
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = content[10 + i % (content.size() - 10)];
  return image;
}

}  // namespace trueshade
