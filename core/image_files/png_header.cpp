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

/// The colour types, and which numbers of bits each has (table 11.1). Bit k of `depths` stands for k bits.
struct PngColorType {
  uint8_t number;
  std::string_view channels;
  uint32_t depths;
};
constexpr uint32_t k8Or16 = 1u << 8 | 1u << 16, kUpTo8 = 1u << 1 | 1u << 2 | 1u << 4 | 1u << 8;
constexpr PngColorType kColorTypes[] = {{0, "Y", kUpTo8 | 1u << 16},
                                        {2, "RGB", k8Or16},
                                        {3, "P", kUpTo8},  // an index into a palette
                                        {4, "YA", k8Or16},
                                        {6, "RGBA", k8Or16}};

/// False for a colour type or a depth that PNG does not have.
bool read_size_and_channels(std::span<const uint8_t> data, ImageFileInfo& header) {
  header.width = int(png_word_at(data, 0));
  header.height = int(png_word_at(data, 4));
  const uint8_t bits = data[8];
  for (const PngColorType& type : kColorTypes) {
    if (type.number != data[9] || bits > 16 || (type.depths >> bits & 1) == 0) continue;
    for (const char name : type.channels) header.channels.push_back(name + (" uint" + std::to_string(int(bits))));
    return true;
  }
  return false;
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
      if (!read_size_and_channels(data, header))
        throw refuse(at, "the IHDR has a colour type or a bit depth that PNG does not know");
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

bool png_has_chunk(std::span<const uint8_t> bytes, std::string_view type) {
  for (size_t at = kPngSignatureBytes; at + kPngChunkOverhead <= bytes.size();) {
    if (text_of(bytes.subspan(at + 4, 4)) == type) return true;
    at += png_word_at(bytes, at) + kPngChunkOverhead;
  }
  return false;
}

}  // namespace trueshade
