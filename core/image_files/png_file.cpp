// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5, 9.2 and 11.
#include "core/image_files/png_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "core/error.h"
#include "core/image_files/deflate.h"
#include "core/image_files/file_budget.h"
#include "core/image_files/png_codes.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr uint8_t kUp = 2;  // the filter that subtracts the byte above

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
  const bool is_ascii = std::all_of(text.begin(), text.end(), [&](char c) { return ascii(c) || c == '\n'; });
  std::vector<uint8_t> data;
  append_text(data, key);
  // Behind the keyword an iTXt has its compression flag and method, a language and a translated keyword.
  data.insert(data.end(), is_ascii ? 1 : 5, uint8_t(0));
  append_text(data, text);
  append_chunk(file, is_ascii ? "tEXt" : "iTXt", data);
}

/// Rows that are compressed together. They depend on the image alone, so that every number of threads gives one file.
int rows_of_band(size_t row_bytes) {
  constexpr size_t kLeastRows = 64, kLeastBytes = size_t(1) << 18;
  return int(std::max(kLeastRows, kLeastBytes / row_bytes));
}

/// Some rows of the picture as an IDAT chunk: a part of the compressed stream.
struct Band {
  std::vector<uint8_t> chunk;
  uint32_t checksum;  ///< of the rows before they are compressed
  uint64_t bytes;     ///< of these
};

/// Rows [first, end), each behind the byte that names the filter.
std::vector<uint8_t> filtered_rows(const PngCodes& codes, int first, int end) {
  const size_t row_bytes = codes.row_bytes();
  std::vector<uint8_t> above(row_bytes), row(row_bytes), rows((row_bytes + 1) * size_t(end - first));
  if (first > 0) codes.row(first - 1, above.data());
  uint8_t* out = rows.data();
  for (int y = first; y < end; ++y, above.swap(row)) {
    codes.row(y, row.data());
    *out++ = kUp;
    const uint8_t *const these = row.data(), *const those = above.data();
    for (size_t i = 0; i < row_bytes; ++i) out[i] = uint8_t(these[i] - those[i]);
    out += row_bytes;
  }
  return rows;
}

Band band_of(const PngCodes& codes, int first, int end, Deflater::Part part) {
  const std::vector<uint8_t> rows = filtered_rows(codes, first, end);
  std::vector<uint8_t> stream;
  if (first == 0) stream.assign(kZlibHeader.begin(), kZlibHeader.end());
  Deflater().append(rows, part, stream);
  Band band{{}, adler_of(rows), rows.size()};
  band.chunk.reserve(stream.size() + 12);
  append_chunk(band.chunk, "IDAT", stream);
  return band;
}

/// The picture's IDAT chunks. The last has the checksum of the stream alone, which is known when all others are made.
std::vector<std::vector<uint8_t>> picture_chunks(const std::string& where, int height, const PngCodes& codes,
                                                 int threads) {
  const int rows = rows_of_band(codes.row_bytes()), count = (height + rows - 1) / rows;
  std::vector<Band> bands(static_cast<size_t>(count));
  FileBudget budget(where);
  parallel_for(count, threads, [&](int i) {
    const int end = std::min((i + 1) * rows, height);
    bands[size_t(i)] = band_of(codes, i * rows, end, i + 1 == count ? Deflater::Part::last : Deflater::Part::inner);
    budget.take(bands[size_t(i)].chunk.size());
  });
  uint32_t checksum = kAdlerOfNothing;
  std::vector<std::vector<uint8_t>> chunks;
  for (Band& band : bands) {
    checksum = adler_of_both(checksum, band.checksum, band.bytes);
    chunks.push_back(std::move(band.chunk));
  }
  append_chunk(chunks.emplace_back(), "IDAT", zlib_trailer(checksum));
  return chunks;
}

}  // namespace

std::vector<std::vector<uint8_t>> png_file(const std::string& where, const Image& image, const Metadata& metadata,
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

  std::vector<std::vector<uint8_t>> pieces = picture_chunks(where, image.height, codes, options.threads);
  pieces.insert(pieces.begin(), std::move(file));
  append_chunk(pieces.back(), "IEND", {});
  return pieces;
}

}  // namespace trueshade
