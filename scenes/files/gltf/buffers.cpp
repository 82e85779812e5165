#include "scenes/files/gltf/buffers.h"

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/files/gltf/data_uri.h"
#include "scenes/files/gltf/meshopt.h"

namespace trueshade::gltf {

Buffers::Buffers(const Document& document, const Container& container, const SceneFolder& folder,
                 const SceneLimits& limits)
    : document_(document),
      folder_(folder),
      left_(limits.buffer_bytes),
      limit_(limits.buffer_bytes),
      paths_(limits.named_paths) {
  owned_.resize(document.buffers.size());
  buffers_.resize(document.buffers.size());
  unpacked_.resize(document.views.size());
  for (size_t i = 0; i < document.buffers.size(); ++i) {
    const Buffer& buffer = document.buffers[i];
    const std::string pointer = pointer_to("buffers", i), where = document.file + ": " + pointer;
    if (buffer.uri) {
      owned_[i] = bytes_of_uri(*buffer.uri, where + "/uri");
      buffers_[i] = owned_[i];
    } else if (i == 0 && container.bin) {
      buffers_[i] = *container.bin;
      take(buffers_[i].size(), where);
    } else if (i == 0 && container.is_glb && !buffer.fallback) {
      document.fail(pointer, "the file has no chunk BIN for this buffer", "a chunk BIN, or a uri");
    } else {
      continue;  // it may belong to an extension; an accessor that reads it is refused
    }
    if (buffers_[i].size() < buffer.bytes)
      document.fail(pointer,
                    "there are " + std::to_string(buffers_[i].size()) + " bytes and byteLength says " +
                        std::to_string(buffer.bytes),
                    "all of the data");
    buffers_[i] = buffers_[i].first(size_t(buffer.bytes));
  }
}

void Buffers::take(uint64_t bytes, const std::string& where) {
  if (bytes > left_)
    throw Error(ErrorKind::limit, where,
                "with these " + std::to_string(bytes) + " bytes the buffers are over the limit",
                within_limit(limit_, "bytes in all", "--max-buffer-memory"));
  left_ -= bytes;
  require_memory(bytes, where, "the buffer");
}

Bytes Buffers::bytes_of_uri(const std::string& uri, const std::string& where) {
  Bytes bytes;
  if (is_data_uri(uri)) {
    DataUri data = data_of_uri(uri, where, left_);
    if (data.media_type != "application/octet-stream" && data.media_type != "application/gltf-buffer")
      throw Error(ErrorKind::bad_input, where, "the data URI is not of a buffer's type",
                  "application/octet-stream or application/gltf-buffer");
    bytes = std::move(data.bytes);
  } else {
    bytes = folder_.read(path_from_uri(uri, where, paths_), left_, where);
  }
  take(bytes.size(), where);
  return bytes;
}

std::span<const uint8_t> Buffers::buffer(uint32_t index, const std::string& where) const {
  if (buffers_[index].empty())
    throw Error(ErrorKind::bad_input, where, "buffer " + std::to_string(index) + " has no data",
                "a uri, or a chunk BIN for the first buffer of a .glb file");
  return buffers_[index];
}

std::span<const uint8_t> Buffers::view(uint32_t index) {
  const BufferView& view = document_.views[index];
  const std::string where = document_.file + ": " + pointer_to("bufferViews", index);
  if (!view.packing) return buffer(view.buffer, where).subspan(size_t(view.offset), size_t(view.bytes));
  if (!unpacked_[index]) {
    const Packing& packing = *view.packing;
    take(view.bytes, where);
    unpacked_[index] = std::make_unique<Bytes>(unpacked_by_meshopt(
        packing, buffer(packing.buffer, where).subspan(size_t(packing.offset), size_t(packing.bytes)),
        where + "/extensions/EXT_meshopt_compression"));
  }
  return *unpacked_[index];
}

}  // namespace trueshade::gltf
