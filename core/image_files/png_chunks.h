#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image_files/deflate.h"
#include "core/image_files/png_codes.h"

namespace trueshade {

/// Appends a chunk: its length, its type of four letters, the data and their checksum (W3C, PNG Specification (Second
/// Edition), section 5.3).
void append_png_chunk(std::vector<uint8_t>& file, std::string_view type, std::span<const uint8_t> data);

/// Appends metadata, as tEXt where the text is ASCII, else as iTXt, which is UTF-8. Error(usage) naming `where` for a
/// key that is not 1 to 79 letters of ASCII.
void append_png_text(std::vector<uint8_t>& file, const std::string& where, std::string_view key, std::string_view text);

/// The bytes of a file before its pixels: signature, IHDR, tags, metadata. `codes`: of any image of the picture's
/// format. Error(usage) for metadata that a PNG cannot hold.
std::vector<uint8_t> png_head(const std::string& where, int width, int height, const PngCodes& codes,
                              const Metadata& metadata);

/// The filter that subtracts the byte above, and the one that leaves bytes as they are.
inline constexpr uint8_t kPngUp = 2, kPngNone = 0;

/// Rows [first, end) of the codes, each behind the byte that names its filter: kPngUp, but kPngNone for the first where
/// the row above it is not at hand.
enum class RowsAbove : uint8_t { known, none };
std::vector<uint8_t> filtered_png_rows(const PngCodes& codes, int first, int end, RowsAbove above);

/// Some rows of the picture as an IDAT chunk: a part of the compressed stream.
struct PngRows {
  std::vector<uint8_t> chunk;
  uint32_t checksum;  ///< Adler-32 of the rows before they are compressed
  uint64_t bytes;     ///< of these
};
/// `stream_begins`: the chunk is the first.
PngRows png_rows_of(std::span<const uint8_t> filtered, bool stream_begins, Deflater::Part part);

}  // namespace trueshade
