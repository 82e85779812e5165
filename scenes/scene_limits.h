#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/expansion.h"

namespace trueshade {

/// What becomes of faults of a file that harm its looks alone (scenes/files/content/faults.h).
enum class Leniency : uint32_t {
  refused,  ///< they are errors
  offered,  ///< they are errors, which name --lenient
  asked,    ///< they are passed over, and Scene::passed_over says which
};

/// Which files a scene may name.
enum class NamedPaths : uint32_t {
  inside,  ///< those in its folder and below
  any,     ///< --trust-paths: all that the user may read, by absolute paths and links, too
};

/// Limits that a scene is held to while it is read, before memory for more is taken. Each has an option of the command,
/// which its error names.
struct SceneLimits {
  uint64_t lights = uint64_t(1) << 20;         ///< --max-lights
  uint64_t instances = uint64_t(16) << 20;     ///< --max-instances
  uint64_t file_bytes = uint64_t(1) << 30;     ///< --max-file: of each file, and of what a .gz file holds
  uint64_t json_bytes = uint64_t(256) << 20;   ///< --max-json: of a scene's text
  uint64_t texture_bytes = uint64_t(4) << 30;  ///< --max-texture-memory: of all textures with their levels, as stored
  uint64_t buffer_bytes = uint64_t(4) << 30;  ///< --max-buffer-memory: of a glTF file's buffers and what they unpack to
  uint64_t geometry_bytes =
      uint64_t(4) << 30;                ///< --max-geometry-memory: of vertices and indices of a glTF or OBJ file
  uint64_t nodes = 1000000;             ///< --max-nodes: of a glTF file
  uint64_t node_depth = 1024;           ///< --max-node-depth: nodes inside each other
  uint64_t expansion = kMostExpansion;  ///< --max-expansion: of compressed content, where it is over 64 MiB
  Leniency leniency = Leniency::refused;
  NamedPaths named_paths = NamedPaths::inside;
};

/// The remedy of a limit: `at most 512 bytes, or a higher --max-file`.
inline std::string within_limit(uint64_t limit, std::string_view unit, std::string_view option) {
  std::string text = "at most " + std::to_string(limit);
  if (!unit.empty()) text += ' ' + std::string(unit);
  return option.empty() ? text : text + ", or a higher " + std::string(option);
}

/// What an instance takes until it is drawn: itself, its transforms, its place in the lists of clusters.
inline constexpr uint64_t kDrawnInstanceBytes = 272;

}  // namespace trueshade
