// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5, 9.2 and 11.
#include "core/image_files/png_chunks.h"

#include <libdeflate.h>

#include <algorithm>

#include "core/error.h"

namespace trueshade {
namespace {

void append_word(std::vector<uint8_t>& bytes, uint32_t word) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(uint8_t(word >> shift));
}

void append_text(std::vector<uint8_t>& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

void append_header(std::vector<uint8_t>& file, int width, int height, const PngCodes& codes) {
  constexpr uint8_t kColorTypes[] = {0, 4, 2, 6};  // of one to four channels
  std::vector<uint8_t> header;
  append_word(header, uint32_t(width));
  append_word(header, uint32_t(height));
  header.insert(header.end(), {uint8_t(codes.bits()), kColorTypes[codes.channels() - 1], 0, 0, 0});
  append_png_chunk(file, "IHDR", header);
}

void append_tag(std::vector<uint8_t>& file, PngTag tag) {
  constexpr uint8_t kPerceptual[] = {0};
  std::vector<uint8_t> gamma;
  append_word(gamma, tag == PngTag::srgb ? 45455 : 100000);
  if (tag == PngTag::srgb) append_png_chunk(file, "sRGB", kPerceptual);
  append_png_chunk(file, "gAMA", gamma);
}

}  // namespace

void append_png_chunk(std::vector<uint8_t>& file, std::string_view type, std::span<const uint8_t> data) {
  append_word(file, uint32_t(data.size()));
  const size_t start = file.size();
  append_text(file, type);
  file.insert(file.end(), data.begin(), data.end());
  append_word(file, libdeflate_crc32(0, file.data() + start, file.size() - start));
}

void append_png_text(std::vector<uint8_t>& file, const std::string& where, std::string_view key,
                     std::string_view text) {
  const auto ascii = [](char c) { return c >= ' ' && c <= '~'; };
  constexpr size_t kMostKey = 79;
  if (key.empty() || key.size() > kMostKey || !std::all_of(key.begin(), key.end(), ascii))
    throw Error(ErrorKind::usage, where, "a PNG cannot hold metadata named '" + std::string(key) + "'",
                "name it with 1 to 79 letters of ASCII");
  const bool is_ascii = std::all_of(text.begin(), text.end(), [&](char c) { return ascii(c) || c == '\n'; });
  std::vector<uint8_t> data;
  append_text(data, key);
  // Behind the keyword an iTXt has its compression flag and method, a language and a translated keyword.
  data.insert(data.end(), is_ascii ? 1 : 5, uint8_t(0));
  append_text(data, text);
  append_png_chunk(file, is_ascii ? "tEXt" : "iTXt", data);
}

std::vector<uint8_t> png_head(const std::string& where, int width, int height, const PngCodes& codes,
                              const Metadata& metadata) {
  std::vector<uint8_t> file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_header(file, width, height, codes);
  append_tag(file, codes.tag());
  append_png_text(file, where, "Software", "trueshade");
  for (const auto& [key, text] : metadata) append_png_text(file, where, key, text);
  return file;
}

std::vector<uint8_t> filtered_png_rows(const PngCodes& codes, int first, int end, RowsAbove rows_above) {
  const size_t row_bytes = codes.row_bytes();
  std::vector<uint8_t> above(row_bytes), row(row_bytes), rows((row_bytes + 1) * size_t(end - first));
  if (first > 0 && rows_above == RowsAbove::known) codes.row(first - 1, above.data());
  uint8_t* out = rows.data();
  for (int y = first; y < end; ++y, above.swap(row)) {
    codes.row(y, row.data());
    *out++ = y == first && rows_above == RowsAbove::none ? kPngNone : kPngUp;
    const uint8_t *const these = row.data(), *const those = above.data();  // zeros above the first
    for (size_t i = 0; i < row_bytes; ++i) out[i] = uint8_t(these[i] - those[i]);
    out += row_bytes;
  }
  return rows;
}

PngRows png_rows_of(std::span<const uint8_t> filtered, bool stream_begins, Deflater::Part part) {
  std::vector<uint8_t> stream;
  if (stream_begins) stream.assign(kZlibHeader.begin(), kZlibHeader.end());
  Deflater().append(filtered, part, stream);
  PngRows rows{{}, adler_of(filtered), filtered.size()};
  rows.chunk.reserve(stream.size() + 12);
  append_png_chunk(rows.chunk, "IDAT", stream);
  return rows;
}

}  // namespace trueshade
