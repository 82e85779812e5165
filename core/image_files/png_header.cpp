// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5.3, 11.2.2 and 11.3.4.3.
#include "core/image_files/png_header.h"

#include <algorithm>

#include "core/error.h"

namespace trueshade {
namespace {

constexpr size_t kSignatureBytes = 8, kChunkOverhead = 12;  // a chunk: length, type, data, CRC

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 | uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

std::string text_of(std::span<const uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

void read_size_and_channels(std::span<const uint8_t> data, ImageFileInfo& header) {
  header.width = int(word_at(data, 0));
  header.height = int(word_at(data, 4));
  const std::string depth = " uint" + std::to_string(int(data[8]));
  std::string_view names;
  switch (data[9]) {
    case 0:
      names = "Y";
      break;
    case 2:
      names = "RGB";
      break;
    case 3:
      names = "P";
      break;  // an index into a palette
    case 4:
      names = "YA";
      break;
    default:
      names = "RGBA";
      break;
  }
  for (const char name : names) header.channels.push_back(name + depth);
}

}  // namespace

ImageFileInfo png_header(const std::string& where, std::span<const uint8_t> bytes) {
  const auto refuse = [&where](size_t at, const char* reason) {
    return Error(ErrorKind::bad_input, where + ": byte " + std::to_string(at), reason, "write the file again");
  };
  ImageFileInfo header;
  for (size_t at = kSignatureBytes;;) {
    if (bytes.size() - std::min(at, bytes.size()) < kChunkOverhead) throw refuse(at, "the PNG ends before its IEND");
    const size_t length = word_at(bytes, at);
    const std::string type = text_of(bytes.subspan(at + 4, 4));
    if (length > bytes.size() - at - kChunkOverhead) throw refuse(at, "a PNG chunk is longer than the file");
    const std::span<const uint8_t> data = bytes.subspan(at + 8, length);
    if ((at == kSignatureBytes) != (type == "IHDR")) throw refuse(at, "a PNG begins with one IHDR");
    if (type == "IHDR") {
      if (length != 13 || word_at(data, 0) - 1 > 0x7ffffffeu || word_at(data, 4) - 1 > 0x7ffffffeu)
        throw refuse(at, "the IHDR has not 13 bytes or a side out of range");
      read_size_and_channels(data, header);
    } else if (type == "tEXt") {
      const auto key_end = std::find(data.begin(), data.end(), uint8_t(0));
      if (key_end == data.end()) throw refuse(at, "a tEXt chunk has no end of its keyword");
      header.metadata.emplace_back(std::string(data.begin(), key_end), std::string(key_end + 1, data.end()));
    } else if (type == "IEND") {
      return header;
    }
    at += length + kChunkOverhead;
  }
}

}  // namespace trueshade
