// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5, 9.2 and 11.
#include "core/image_files/png_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "core/error.h"
#include "core/image_files/deflate.h"
#include "core/image_files/png_codes.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr int kRowsOfBand = 64;
constexpr size_t kMostChunk = size_t(1) << 30;  // a chunk has fewer than 2^31 bytes
constexpr uint8_t kUp = 2;                      // the filter that subtracts the byte above

void append_word(std::vector<uint8_t>& bytes, uint32_t word) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(uint8_t(word >> shift));
}

void append_text(std::vector<uint8_t>& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

void append_chunk(std::vector<uint8_t>& file, std::string_view type, std::span<const uint8_t> data) {
  append_word(file, uint32_t(data.size()));
  const size_t start = file.size();
  append_text(file, type);
  file.insert(file.end(), data.begin(), data.end());
  append_word(file, libdeflate_crc32(0, file.data() + start, file.size() - start));
}

void append_header(std::vector<uint8_t>& file, const Image& image, const PngCodes& codes) {
  constexpr uint8_t kColorTypes[] = {0, 4, 2, 6};  // of one to four channels
  std::vector<uint8_t> header;
  append_word(header, uint32_t(image.width));
  append_word(header, uint32_t(image.height));
  header.insert(header.end(), {uint8_t(codes.bits()), kColorTypes[codes.channels() - 1], 0, 0, 0});
  append_chunk(file, "IHDR", header);
}

void append_tag(std::vector<uint8_t>& file, PngTag tag) {
  constexpr uint8_t kPerceptual[] = {0};
  std::vector<uint8_t> gamma;
  append_word(gamma, tag == PngTag::srgb ? 45455 : 100000);
  if (tag == PngTag::srgb) append_chunk(file, "sRGB", kPerceptual);
  append_chunk(file, "gAMA", gamma);
}

/// As tEXt where the text is ASCII, else as iTXt, which is UTF-8.
void append_metadata(std::vector<uint8_t>& file, const std::string& where, std::string_view key,
                     std::string_view text) {
  const auto ascii = [](char c) { return c >= ' ' && c <= '~'; };
  constexpr size_t kMostKey = 79;
  if (key.empty() || key.size() > kMostKey || !std::all_of(key.begin(), key.end(), ascii))
    throw Error(ErrorKind::usage, where, "a PNG cannot hold metadata named '" + std::string(key) + "'",
                "name it with 1 to 79 letters of ASCII");
  const bool plain = std::all_of(text.begin(), text.end(), [&](char c) { return ascii(c) || c == '\n'; });
  std::vector<uint8_t> data;
  append_text(data, key);
  // Behind the keyword an iTXt has its compression flag and method, a language and a translated keyword.
  data.insert(data.end(), plain ? 1 : 5, uint8_t(0));
  append_text(data, text);
  append_chunk(file, plain ? "tEXt" : "iTXt", data);
}

/// All rows, each behind the byte that names the filter.
Buffer filtered_rows(int height, const PngCodes& codes, int threads) {
  const size_t row_bytes = codes.row_bytes();
  Buffer rows((row_bytes + 1) * size_t(height));
  const auto filter_band = [&](int band) {
    const int first = band * kRowsOfBand, end = std::min(first + kRowsOfBand, height);
    std::vector<uint8_t> above(row_bytes), row(row_bytes);
    if (first > 0) codes.row(first - 1, above.data());
    for (int y = first; y < end; ++y, above.swap(row)) {
      codes.row(y, row.data());
      uint8_t* const out = rows.bytes.get() + size_t(y) * (row_bytes + 1);
      out[0] = kUp;
      for (size_t i = 0; i < row_bytes; ++i) out[1 + i] = uint8_t(row[i] - above[i]);
    }
  };
  parallel_for((height + kRowsOfBand - 1) / kRowsOfBand, threads, filter_band);
  return rows;
}

}  // namespace

std::vector<uint8_t> png_file(const std::string& where, const Image& image, const Metadata& metadata,
                              const ImageFileOptions& options) {
  if (image.width < 1 || image.height < 1 || info(image.format).number_class == NumberClass::integer)
    throw Error(ErrorKind::usage, where, "a PNG holds neither an image without pixels nor integers",
                "write another image");
  const PngCodes codes(image, options);
  std::vector<uint8_t> file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_header(file, image, codes);
  append_tag(file, codes.tag());
  append_metadata(file, where, "Software", "trueshade");
  for (const auto& [key, text] : metadata) append_metadata(file, where, key, text);

  const Buffer rows = filtered_rows(image.height, codes, options.threads);
  const Buffer stream(Deflater::most(rows.size));
  const size_t size = Deflater().compress(rows.first(rows.size), stream.first(stream.size));
  file.reserve(file.size() + size + 64);
  for (size_t at = 0; at < size; at += kMostChunk)
    append_chunk(file, "IDAT", stream.first(size).subspan(at, std::min(kMostChunk, size - at)));
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace trueshade
