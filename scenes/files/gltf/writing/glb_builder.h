#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/mesh.h"

namespace trueshade::gltf {

/// A GLB file in the making: its binary chunk, and the lists of its JSON by name.
class GlbBuilder {
 public:
  /// Index of a new view of these bytes, which start on a multiple of 4.
  uint32_t view(std::span<const uint8_t> bytes);

  /// Index of a new accessor of one float or index a vertex and stream, in a view of its own. Bounds are those that
  /// POSITION needs.
  uint32_t accessor(std::span<const FloatStream> streams, bool with_bounds);
  uint32_t accessor(std::span<const uint32_t> indices, size_t vertices);

  /// Index of a new accessor that has no data: pairs of zeros.
  uint32_t zeros(size_t count);

  /// Appends an element to a list of the root, such as "nodes"; its index.
  uint32_t add(std::string_view list, const std::string& element);

  /// The same, once for each text.
  uint32_t add_once(std::string_view list, const std::string& element);

  /// Names an extension that the file uses.
  void use(std::string_view extension);

  size_t count(std::string_view list) const;

  /// The file: header, JSON and binary chunk. `members` are the root's others, such as `"scene":0`. Error(limit) where
  /// JSON or file would be larger than readers of ours or the format take.
  std::vector<uint8_t> file(const std::string& members, const std::string& name) &&;

 private:
  struct List {
    std::string text;
    uint32_t count = 0;
    std::map<std::string, uint32_t> known;
  };
  std::string json(const std::string& members) const;

  std::vector<uint8_t> data_;
  std::map<std::string, List, std::less<>> lists_;
  std::map<std::string, bool, std::less<>> extensions_;
};

}  // namespace trueshade::gltf
