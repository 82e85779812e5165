#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace trueshade::gltf {

/// What a .glb or .gltf file holds. Borrows the file's bytes.
struct Container {
  std::string_view json;
  std::optional<std::span<const uint8_t>> bin;  ///< the chunk BIN of a .glb file
  bool is_glb = false;
};

/// Splits a file's content. It is GLB if its name ends in .glb or it starts with GLB's magic number; else all of it is
/// JSON. Error(bad_input) with the byte where the container breaks glTF 2.0, 4.
Container container_of(std::span<const uint8_t> file, const std::string& name);

}  // namespace trueshade::gltf
