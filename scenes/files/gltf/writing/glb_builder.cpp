#include "scenes/files/gltf/writing/glb_builder.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "scenes/files/gltf/extras/field_writer.h"
#include "scenes/scene.h"

namespace trueshade::gltf {
namespace {

static_assert(std::endian::native == std::endian::little);

std::string view_and_count(uint32_t view, size_t count, const char* rest) {
  return "{\"bufferView\":" + std::to_string(view) + ",\"count\":" + std::to_string(count) + rest;
}

void append_word(std::vector<uint8_t>& out, uint32_t word) {
  const size_t at = out.size();
  out.resize(at + sizeof word);
  std::memcpy(out.data() + at, &word, sizeof word);
}

constexpr size_t padded(size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

uint32_t GlbBuilder::view(std::span<const uint8_t> bytes) {
  data_.resize(padded(data_.size()));
  const size_t offset = data_.size();
  data_.insert(data_.end(), bytes.begin(), bytes.end());
  return add("bufferViews", "{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) +
                                ",\"byteLength\":" + std::to_string(bytes.size()) + "}");
}

uint32_t GlbBuilder::accessor(std::span<const FloatStream> streams, bool with_bounds) {
  constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const size_t count = streams[0].size(), width = streams.size();
  std::vector<float> values(count * width);
  for (size_t k = 0; k < width; ++k)
    for (size_t i = 0; i < count; ++i) values[i * width + k] = streams[k][i];
  const uint32_t at = view({reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(float)});
  std::string text = view_and_count(at, count, ",\"componentType\":5126,\"type\":\"") + kTypes[width] + '"';
  if (with_bounds) {
    std::vector<float> least, most;
    for (const FloatStream& stream : streams) {
      const auto [low, high] = std::minmax_element(stream.begin(), stream.end());
      least.push_back(*low), most.push_back(*high);
    }
    append_json(text += ",\"min\":", std::span<const float>(least));
    append_json(text += ",\"max\":", std::span<const float>(most));
  }
  return add("accessors", text + "}");
}

uint32_t GlbBuilder::accessor(std::span<const uint32_t> indices, size_t vertices) {
  if (vertices <= UINT16_MAX) {
    const std::vector<uint16_t> narrow(indices.begin(), indices.end());
    const uint32_t at = view({reinterpret_cast<const uint8_t*>(narrow.data()), narrow.size() * sizeof(uint16_t)});
    return add("accessors", view_and_count(at, indices.size(), ",\"componentType\":5123,\"type\":\"SCALAR\"}"));
  }
  const uint32_t at = view({reinterpret_cast<const uint8_t*>(indices.data()), indices.size_bytes()});
  return add("accessors", view_and_count(at, indices.size(), ",\"componentType\":5125,\"type\":\"SCALAR\"}"));
}

uint32_t GlbBuilder::zeros(size_t count) {
  return add_once("accessors", "{\"count\":" + std::to_string(count) + ",\"componentType\":5126,\"type\":\"VEC2\"}");
}

uint32_t GlbBuilder::add(std::string_view list, const std::string& element) {
  List& to = lists_[std::string(list)];
  if (to.count > 0) to.text += ',';
  to.text += element;
  return to.count++;
}

uint32_t GlbBuilder::add_once(std::string_view list, const std::string& element) {
  List& to = lists_[std::string(list)];
  const auto found = to.known.find(element);
  if (found != to.known.end()) return found->second;
  const uint32_t index = add(list, element);
  to.known.emplace(element, index);
  return index;
}

void GlbBuilder::use(std::string_view extension) { extensions_[std::string(extension)] = true; }

size_t GlbBuilder::count(std::string_view list) const {
  const auto found = lists_.find(list);
  return found == lists_.end() ? 0 : found->second.count;
}

std::string GlbBuilder::json(const std::string& members) const {
  std::string text = R"({"asset":{"version":"2.0","generator":"trueshade"})";
  if (!data_.empty()) text += ",\"buffers\":[{\"byteLength\":" + std::to_string(data_.size()) + "}]";
  for (const auto& [name, list] : lists_) text += ",\"" + name + "\":[" + list.text + ']';
  std::string used;
  for (const auto& [name, on] : extensions_) used += (used.empty() ? "\"" : ",\"") + name + '"';
  if (!used.empty()) text += ",\"extensionsUsed\":[" + used + ']';
  text += ',' + members + '}';
  text.resize(padded(text.size()), ' ');
  return text;
}

std::vector<uint8_t> GlbBuilder::file(const std::string& members, const std::string& name) && {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  data_.resize(padded(data_.size()));
  const std::string text = json(members);
  if (text.size() > SceneLimits().json_bytes)
    throw Error(ErrorKind::limit, name,
                std::to_string(text.size()) + " bytes of JSON are over the limit of what is read",
                "a scene with fewer objects and lights");
  const uint64_t bytes = kHeader + kChunkHeader + text.size() + (data_.empty() ? 0 : kChunkHeader + data_.size());
  if (bytes > SceneLimits().file_bytes)
    throw Error(ErrorKind::limit, name, "the file would have " + std::to_string(bytes) + " bytes",
                "at most " + std::to_string(SceneLimits().file_bytes) + ", which is what is read");
  std::vector<uint8_t> out;
  out.reserve(size_t(bytes));
  for (const uint32_t word : {0x46546C67u, 2u, uint32_t(bytes), uint32_t(text.size()), 0x4E4F534Au})
    append_word(out, word);
  out.insert(out.end(), text.begin(), text.end());
  if (data_.empty()) return out;
  append_word(out, uint32_t(data_.size()));
  append_word(out, 0x004E4942u);
  out.insert(out.end(), data_.begin(), data_.end());
  return out;
}

}  // namespace trueshade::gltf
