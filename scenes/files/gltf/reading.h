#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scenes/files/gltf/document.h"
#include "scenes/json/json_value.h"

// How the parts of a document are read from JSON. A Node borrows its parent, so that parents stand in variables.
namespace trueshade::gltf {

inline constexpr double kLargest = 1e18;                    ///< of numbers in a document
inline constexpr int64_t kLargestCount = int64_t(1) << 53;  ///< whole numbers of JSON are exact up to here

/// How many elements the lists have that others point into.
struct Counts {
  uint32_t buffers = 0, views = 0, accessors = 0, images = 0, samplers = 0, textures = 0, materials = 0, meshes = 0,
           nodes = 0, skins = 0, cameras = 0, lights = 0, scenes = 0;
};

/// An index below `count`; the error calls an element `one`.
uint32_t index(const json::Node& node, uint32_t count, std::string_view one);
uint32_t index_or_none(const json::Node& object, std::string_view key, uint32_t count, std::string_view one);

uint64_t whole_or(const json::Node& object, std::string_view key, uint64_t absent, int64_t least = 0,
                  int64_t most = kLargestCount);
double number_or(const json::Node& object, std::string_view key, double absent, double least, double most);
bool boolean_or(const json::Node& object, std::string_view key, bool absent);
std::string string_or_empty(const json::Node& object, std::string_view key);

/// The place of a string in `names`, or names.size(): lists that extensions may add to.
size_t known_or_other(const json::Node& node, std::span<const std::string_view> names);

/// The numbers under "weights"; none where the key is absent.
std::vector<double> read_weights(const json::Node& object);

/// The object's "extensions", each of which is an object.
std::optional<json::Node> extensions_of(const json::Node& object);

/// Calls read(element, index) for each element of a list, which is not empty; nothing where the key is absent.
template <typename Read>
void for_each(const json::Node& object, std::string_view key, const Read& read) {
  const auto list = object.find(key);
  if (!list) return;
  const size_t count = list->array(1, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node element = list->element(i);
    read(element, i);
  }
}

// The parts of a document, each read by a file read_*.cpp. The lists of `document` that a part fills are empty before.
void read_data(const json::Node& root, const Counts& counts, Document& document);       // buffers, views, accessors
void read_materials(const json::Node& root, const Counts& counts, Document& document);  // images, textures too
void read_meshes(const json::Node& root, const Counts& counts, Document& document);
void read_nodes(const json::Node& root, const Counts& counts, Document& document);  // skins, scenes too
void read_lights_and_cameras(const json::Node& root, Document& document);
void read_animations(const json::Node& root, const Counts& counts, Document& document);

}  // namespace trueshade::gltf
