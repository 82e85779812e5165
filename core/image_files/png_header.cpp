// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5.3, 11.2.2 and 11.3.4.3.
#include "core/image_files/png_header.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>

#include "core/error.h"

namespace trueshade {
namespace {

std::string text_of(std::span<const uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

void read_size_and_channels(std::span<const uint8_t> data, ImageFileInfo& header) {
  header.width = int(png_word_at(data, 0));
  header.height = int(png_word_at(data, 4));
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

/// Keyword and text of an iTXt that is not compressed.
std::optional<Metadata::value_type> international_text(std::span<const uint8_t> data) {
  const auto zero = [&](size_t from) {
    return size_t(std::find(data.begin() + std::ptrdiff_t(std::min(from, data.size())), data.end(), uint8_t(0)) -
                  data.begin());
  };
  const size_t key_end = zero(0), language_end = zero(key_end + 3), translation_end = zero(language_end + 1);
  if (translation_end >= data.size() || data[key_end + 1] != 0) return std::nullopt;
  return Metadata::value_type(text_of(data.first(key_end)), text_of(data.subspan(translation_end + 1)));
}

/// What a gAMA chunk says of the codes, where no sRGB chunk says more.
void add_gamma(uint32_t gamma, ImageFileInfo& header) {
  constexpr uint32_t kOne = 100000;
  const bool tagged = std::any_of(header.metadata.begin(), header.metadata.end(),
                                  [](const auto& entry) { return entry.first == "oiio:ColorSpace"; });
  if (gamma == 0 || tagged) return;
  std::ostringstream power;
  power << "gamma 1/" << double(kOne) / double(gamma);
  header.metadata.emplace_back("oiio:ColorSpace", gamma == kOne ? "Linear" : power.str());
}

}  // namespace

ImageFileInfo png_header(const std::string& where, std::span<const uint8_t> bytes) {
  const auto refuse = [&where](size_t at, const char* reason) {
    return Error(ErrorKind::bad_input, where + ": byte " + std::to_string(at), reason, "write the file again");
  };
  ImageFileInfo header;
  uint32_t gamma = 0;
  for (size_t at = kPngSignatureBytes;;) {
    if (bytes.size() - std::min(at, bytes.size()) < kPngChunkOverhead) throw refuse(at, "the PNG ends before its IEND");
    const size_t length = png_word_at(bytes, at);
    const std::string type = text_of(bytes.subspan(at + 4, 4));
    if (length > bytes.size() - at - kPngChunkOverhead) throw refuse(at, "a PNG chunk is longer than the file");
    const std::span<const uint8_t> data = bytes.subspan(at + 8, length);
    if ((at == kPngSignatureBytes) != (type == "IHDR")) throw refuse(at, "a PNG begins with one IHDR");
    if (type == "IHDR") {
      if (length != 13 || png_word_at(data, 0) - 1 > 0x7ffffffeu || png_word_at(data, 4) - 1 > 0x7ffffffeu)
        throw refuse(at, "the IHDR has not 13 bytes or a side out of range");
      read_size_and_channels(data, header);
    } else if (type == "tEXt") {
      const auto key_end = std::find(data.begin(), data.end(), uint8_t(0));
      if (key_end == data.end()) throw refuse(at, "a tEXt chunk has no end of its keyword");
      header.metadata.emplace_back(std::string(data.begin(), key_end), std::string(key_end + 1, data.end()));
    } else if (type == "iTXt") {
      if (const auto text = international_text(data)) header.metadata.push_back(*text);
    } else if (type == "sRGB") {
      header.metadata.emplace_back("oiio:ColorSpace", "sRGB");
    } else if (type == "gAMA" && length == 4) {
      gamma = png_word_at(data, 0);
    } else if (type == "IEND") {
      add_gamma(gamma, header);
      return header;
    }
    at += length + kPngChunkOverhead;
  }
}

}  // namespace trueshade
