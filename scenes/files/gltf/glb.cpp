#include "scenes/files/gltf/glb.h"

#include <bit>
#include <cstring>

#include "core/error.h"
#include "core/file_ending.h"

namespace trueshade::gltf {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBin = 0x004E4942;
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

uint32_t word_at(std::span<const uint8_t> file, size_t at) {
  uint32_t word;
  std::memcpy(&word, file.data() + at, sizeof word);
  return word;
}

[[noreturn]] void refuse(const std::string& name, size_t at, const std::string& reason, const std::string& remedy) {
  throw Error(ErrorKind::bad_input, name + ": byte " + std::to_string(at), reason, remedy);
}

struct Chunk {
  uint32_t type;
  std::span<const uint8_t> data;
  size_t end;  ///< where the next chunk begins
};

/// The chunk at a byte of the file's first `length`.
Chunk chunk_at(std::span<const uint8_t> file, size_t at, size_t length, const std::string& name) {
  if (length - at < kChunkHeaderBytes) refuse(name, at, "a chunk's header is cut off", "write the file again");
  const uint64_t bytes = word_at(file, at);
  if (bytes % 4 != 0) refuse(name, at, "a chunk's length is no multiple of 4", "pad the chunk");
  if (bytes > length - at - kChunkHeaderBytes)
    refuse(name, at, "a chunk of " + std::to_string(bytes) + " bytes reaches beyond the file", "write the file again");
  const size_t data = at + kChunkHeaderBytes;
  return {word_at(file, at + 4), file.subspan(data, size_t(bytes)), data + size_t(bytes)};
}

/// The length that the header states, once it is known to be there.
size_t checked_length(std::span<const uint8_t> file, const std::string& name) {
  if (file.size() < kHeaderBytes) refuse(name, file.size(), "the file ends inside the header", "a whole .glb file");
  if (word_at(file, 0) != kMagic) refuse(name, 0, "a .glb file starts with 'glTF'", "a glTF 2.0 file");
  if (word_at(file, 4) != 2)
    refuse(name, 4, "the container has version " + std::to_string(word_at(file, 4)), "version 2");
  const uint64_t length = word_at(file, 8);
  if (length < kHeaderBytes + kChunkHeaderBytes)
    refuse(name, 8, "the header says " + std::to_string(length) + " bytes, too few for a chunk", "a whole .glb file");
  if (length > file.size())
    refuse(name, 8,
           "the header says " + std::to_string(length) + " bytes and the file has " + std::to_string(file.size()),
           "a whole .glb file");
  return size_t(length);
}

}  // namespace

Container container_of(std::span<const uint8_t> file, const std::string& name) {
  const bool magic = file.size() >= 4 && word_at(file, 0) == kMagic;
  if (!magic && !has_ending(name, ".glb"))
    return {{reinterpret_cast<const char*>(file.data()), file.size()}, std::nullopt, false};
  const size_t length = checked_length(file, name);
  Container out{{}, std::nullopt, true};
  for (size_t at = kHeaderBytes, index = 0; at < length; ++index) {
    const Chunk chunk = chunk_at(file, at, length, name);
    if (index == 0 && chunk.type != kJson) refuse(name, at, "the first chunk is not JSON", "chunks JSON, then BIN");
    if (index == 0 && chunk.data.empty()) refuse(name, at, "the chunk JSON is empty", "a glTF document");
    if (index > 0 && chunk.type == kJson) refuse(name, at, "there are two chunks JSON", "one");
    if (chunk.type == kBin && out.bin) refuse(name, at, "there are two chunks BIN", "one");
    if (chunk.type == kBin && index != 1) refuse(name, at, "the chunk BIN is not the second one", "BIN behind JSON");
    if (chunk.type == kJson) out.json = {reinterpret_cast<const char*>(chunk.data.data()), chunk.data.size()};
    if (chunk.type == kBin) out.bin = chunk.data;
    at = chunk.end;
  }
  return out;
}

}  // namespace trueshade::gltf
