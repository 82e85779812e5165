// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5, 9.2 and 11.
#include "core/image_files/png_file.h"

#include <algorithm>

#include "core/error.h"
#include "core/image_files/deflate.h"
#include "core/image_files/file_budget.h"
#include "core/image_files/png_chunks.h"
#include "core/image_files/png_codes.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

/// Rows that are compressed together. They depend on the image alone, so that every number of threads gives one file.
int rows_of_band(size_t row_bytes) {
  constexpr size_t kLeastRows = 64, kLeastBytes = size_t(1) << 18;
  return int(std::max(kLeastRows, kLeastBytes / row_bytes));
}

/// The picture's IDAT chunks. The last has the checksum of the stream alone, which is known when all others are made.
std::vector<std::vector<uint8_t>> picture_chunks(const std::string& where, int height, const PngCodes& codes,
                                                 int threads) {
  const int rows = rows_of_band(codes.row_bytes()), count = (height + rows - 1) / rows;
  std::vector<PngRows> bands(static_cast<size_t>(count));
  FileBudget budget(where);
  parallel_for(count, threads, [&](int i) {
    const int end = std::min((i + 1) * rows, height);
    bands[size_t(i)] = png_rows_of(filtered_png_rows(codes, i * rows, end, RowsAbove::known), i == 0,
                                   i + 1 == count ? Deflater::Part::last : Deflater::Part::inner);
    budget.take(bands[size_t(i)].chunk.size());
  });
  uint32_t checksum = kAdlerOfNothing;
  std::vector<std::vector<uint8_t>> chunks;
  for (PngRows& band : bands) {
    checksum = adler_of_both(checksum, band.checksum, band.bytes);
    chunks.push_back(std::move(band.chunk));
  }
  append_png_chunk(chunks.emplace_back(), "IDAT", zlib_trailer(checksum));
  return chunks;
}

}  // namespace

std::vector<std::vector<uint8_t>> png_file(const std::string& where, const Image& image, const Metadata& metadata,
                                           const ImageFileOptions& options) {
  if (image.width < 1 || image.height < 1 || info(image.format).number_class == NumberClass::integer)
    throw Error(ErrorKind::usage, where, "a PNG holds neither an image without pixels nor integers",
                "write another image");
  const PngCodes codes(image, options);
  std::vector<std::vector<uint8_t>> pieces = picture_chunks(where, image.height, codes, options.threads);
  pieces.insert(pieces.begin(), png_head(where, image.width, image.height, codes, metadata));
  append_png_chunk(pieces.back(), "IEND", {});
  return pieces;
}

}  // namespace trueshade
