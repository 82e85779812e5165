#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/image_files/image_io.h"

namespace trueshade {

/// Bytes of a PNG's signature, and of a chunk beside its data: length, type, CRC.
inline constexpr size_t kPngSignatureBytes = 8, kPngChunkOverhead = 12;

/// The big-endian word of four bytes.
inline uint32_t png_word_at(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 | uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

/// Size, channels and uncompressed text of a PNG, read from its chunks. Our own, because libpng reports a bad file on
/// standard error itself. Decodes no pixels and checks no CRC. Error(bad_input) naming `where` and the byte offset.
ImageFileInfo png_header(const std::string& where, std::span<const uint8_t> bytes);

/// Whether a PNG whose chunks png_header() has walked has one of that type.
bool png_has_chunk(std::span<const uint8_t> bytes, std::string_view type);

}  // namespace trueshade
