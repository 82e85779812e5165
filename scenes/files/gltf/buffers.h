#pragma once
#include <memory>
#include <span>
#include <vector>

#include "scenes/files/content/scene_files.h"
#include "scenes/files/gltf/document.h"
#include "scenes/scene.h"

namespace trueshade::gltf {

/// The bytes behind a document's buffer views. Borrows document and container.
class Buffers {
 public:
  /// Reads every buffer: the chunk BIN, data URIs, files of the folder. Error(bad_input) with the JSON pointer;
  /// Error(io) for a file that cannot be read; Error(limit) over limits.buffer_bytes in all.
  Buffers(const Document& document, const Container& container, const SceneFolder& folder, const SceneLimits& limits);

  /// Bytes of a view, as many as it says; unpacked where EXT_meshopt_compression packs them, once.
  std::span<const uint8_t> view(uint32_t index);

  const Document& document() const { return document_; }

 private:
  Bytes bytes_of_uri(const std::string& uri, const std::string& where);
  std::span<const uint8_t> buffer(uint32_t index, const std::string& where) const;
  void take(uint64_t bytes, const std::string& where);

  const Document& document_;
  const SceneFolder& folder_;
  uint64_t left_, limit_;
  NamedPaths paths_;
  std::vector<Bytes> owned_;
  std::vector<std::span<const uint8_t>> buffers_;  ///< empty where a buffer has no data
  std::vector<std::unique_ptr<Bytes>> unpacked_;   ///< one a view, made when first asked for
};

}  // namespace trueshade::gltf
