#include "core/image_files/streamed_file.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "core/file_ending.h"
#include "core/fp_env.h"
#include "core/image_files/exr_block.h"
#include "core/image_files/exr_channels.h"
#include "core/image_files/exr_header.h"
#include "core/image_files/growing_file.h"
#include "core/image_files/png_chunks.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr int kTile = kStripRows;  // of an EXR, pixels a side
constexpr std::string_view kHashKey = "trueshade:imageHash", kHashStart = "sha256:";
constexpr size_t kHashDigits = 64;

bool is_png(const std::string& name) {
  if (has_ending(name, ".png")) return true;
  if (has_ending(name, ".exr")) return false;
  throw Error(ErrorKind::usage, name, "no image format has this ending", "end the name in .png or .exr");
}

/// A pixel of the picture, from which encoders learn what channels there are.
Image sample_of(Format format) { return {1, 1, format}; }

std::vector<uint8_t> png_head_of(const std::string& name, const StreamedPicture& picture) {
  const Image sample = sample_of(picture.color);
  return png_head(name, picture.width, picture.height, PngCodes(sample, picture.options), picture.metadata);
}

EncodedRows png_rows(const StreamedPicture& picture, int first_row, const Image& color) {
  const PngCodes codes(color, picture.options);
  const int count = (color.height + kStripRows - 1) / kStripRows;
  std::vector<PngRows> strips(static_cast<size_t>(count));
  parallel_for(count, picture.options.threads, [&](int i) {
    const int first = i * kStripRows, end = std::min(first + kStripRows, color.height);
    const bool begins = first_row + first == 0, ends = first_row + end == picture.height;
    strips[size_t(i)] = png_rows_of(filtered_png_rows(codes, first, end, RowsAbove::none), begins,
                                    ends ? Deflater::Part::last : Deflater::Part::inner);
  });
  EncodedRows rows;
  for (PngRows& strip : strips) {
    rows.checksum = rows.bytes == 0 ? strip.checksum : adler_of_both(rows.checksum, strip.checksum, strip.bytes);
    rows.bytes += strip.bytes;
    rows.pieces.push_back(std::move(strip.chunk));
  }
  return rows;
}

std::vector<uint8_t> png_tail(const std::string& name, uint32_t checksum, const std::string& image_hash) {
  std::vector<uint8_t> tail;
  append_png_chunk(tail, "IDAT", zlib_trailer(checksum));
  append_png_text(tail, name, kHashKey, std::string(kHashStart) + image_hash);
  append_png_chunk(tail, "IEND", {});
  return tail;
}

int tiles_along(int pixels) { return (pixels + kTile - 1) / kTile; }

/// The header with a place for the hash, whose digits begin at `hash_at`.
std::vector<uint8_t> exr_head_of(const std::string& name, const StreamedPicture& picture, uint64_t& hash_at) {
  const Image color = sample_of(picture.color);
  std::vector<NamedImage> planes;
  for (const auto& [plane, format] : picture.planes) planes.push_back({plane, sample_of(format)});
  ExrPicture header{picture.width, picture.height, picture.color, {}, kTile};
  for (const ExrChannel& channel : exr_channels(name, color, planes))
    header.channels.emplace_back(channel.name, channel.type);
  Metadata metadata = picture.metadata;
  const std::string hash(kHashDigits, '0');
  metadata.emplace_back(kHashKey, std::string(kHashStart) + hash);
  const std::vector<uint8_t> head = exr_header_bytes(name, header, metadata, picture.options);
  hash_at =
      uint64_t(std::search(head.rbegin(), head.rend(), hash.begin(), hash.end()).base() - head.begin()) - kHashDigits;
  return head;
}

/// What stands before the pieces, and where it ends.
struct Head {
  uint64_t hash_at = 0;  // EXR: of the hash's digits; stands first, as the making of the others sets it
  std::vector<uint8_t> bytes;
  uint64_t pieces_at;  // behind the offsets of an EXR's tiles

  Head(const std::string& name, const StreamedPicture& picture)
      : bytes(is_png(name) ? png_head_of(name, picture) : exr_head_of(name, picture, hash_at)),
        pieces_at(bytes.size()) {
    if (!is_png(name)) pieces_at += 8 * uint64_t(tiles_along(picture.width)) * uint64_t(tiles_along(picture.height));
  }
  uint64_t table_at() const { return bytes.size(); }
};

/// A column of tiles of some rows.
Image cut_out(const Image& from, int x, int y, int width, int height) {
  Image out(width, height, from.format);
  const size_t texel = size_t(info(from.format).bytes_per_texel());
  for (int row = 0; row < height; ++row) std::memcpy(out.texel(0, row), from.texel(x, y + row), size_t(width) * texel);
  return out;
}

std::vector<uint8_t> exr_tile(const std::string& name, int column, int row, int y, const Image& color,
                              std::span<const NamedImage> planes) {
  const int x = column * kTile, width = std::min(kTile, color.width - x), height = std::min(kTile, color.height - y);
  const Image tile = cut_out(color, x, y, width, height);
  std::vector<NamedImage> tiles;
  for (const NamedImage& plane : planes) tiles.push_back({plane.name, cut_out(plane.image, x, y, width, height)});
  const std::vector<ExrChannel> channels = exr_channels(name, tile, tiles);
  const uint32_t place[] = {uint32_t(column), uint32_t(row), 0, 0};  // and the level
  return ExrBlockWriter(channels, kTile).block(place, 0, height);
}

EncodedRows exr_rows(const std::string& name, const StreamedPicture& picture, int first_row, const Image& color,
                     std::span<const NamedImage> planes) {
  const int columns = tiles_along(color.width), count = columns * tiles_along(color.height);
  EncodedRows rows;
  rows.pieces.resize(size_t(count));
  parallel_for(count, picture.options.threads, [&](int i) {
    const int row = i / columns;
    rows.pieces[size_t(i)] = exr_tile(name, i % columns, first_row / kTile + row, row * kTile, color, planes);
  });
  return rows;
}

}  // namespace

EncodedRows encoded_rows(const std::string& name, const StreamedPicture& picture, int first_row, const Image& color,
                         std::span<const NamedImage> planes) {
  const FpScope ieee;
  return is_png(name) ? png_rows(picture, first_row, color) : exr_rows(name, picture, first_row, color, planes);
}

struct StreamedFile::Work {
  std::string name;
  bool png;
  GrowingFile file;
  StreamedState state;
  uint64_t hash_at = 0, table_at = 0;  // of Head

  Work(const std::string& path, const StreamedPicture& picture, const StreamedState* from)
      : name(path), png(is_png(path)), file(path, from != nullptr) {
    if (!png && file.is_stream())
      throw Error(ErrorKind::usage, path, "tiles of an EXR have a table before them that is written last",
                  "write it to a file, or stream a PNG");
    const Head head(path, picture);
    hash_at = head.hash_at, table_at = head.table_at();
    state.end = head.pieces_at;
    if (from != nullptr) {
      state = *from;
      file.cut(state.end);
    }
    file.put(0, head.bytes);
  }

  /// Where tiles begin.
  void append_table(const EncodedRows& rows) {
    std::vector<uint8_t> table;
    uint64_t at = state.end;
    for (const std::vector<uint8_t>& tile : rows.pieces) {
      for (int shift = 0; shift < 64; shift += 8) table.push_back(uint8_t(at >> shift));
      at += tile.size();
    }
    file.put(table_at + 8 * state.pieces, table);
    state.table_crc = crc_of(table, state.table_crc);
  }
};

StreamedFile::StreamedFile(const std::string& path, const StreamedPicture& picture, const StreamedState* from)
    : work_(std::make_unique<Work>(path, picture, from)) {}
StreamedFile::~StreamedFile() = default;

const StreamedState& StreamedFile::state() const { return work_->state; }

void StreamedFile::append(const EncodedRows& rows) {
  Work& w = *work_;
  if (!w.png) w.append_table(rows);
  for (const std::vector<uint8_t>& piece : rows.pieces) {
    w.file.put(w.state.end, piece);
    w.state.pieces_crc = crc_of(piece, w.state.pieces_crc);
    w.state.end += piece.size();
    ++w.state.pieces;
  }
  if (w.png) w.state.checksum = adler_of_both(w.state.checksum, rows.checksum, rows.bytes);
}

void StreamedFile::sync() { work_->file.sync(); }

void StreamedFile::finish(const std::string& image_hash) {
  Work& w = *work_;
  if (w.png)
    w.file.put(w.state.end, png_tail(w.name, w.state.checksum, image_hash));
  else
    w.file.put(w.hash_at, {reinterpret_cast<const uint8_t*>(image_hash.data()), image_hash.size()});
  w.file.finish();
}

bool part_is_sound(const std::string& path, const StreamedPicture& picture, const StreamedState& state) {
  const GrowingFile part(path, true);
  const Head head(path, picture);
  const auto holds = [&part](uint64_t from, uint64_t end, uint32_t crc) {
    const std::optional<uint32_t> there = part.crc(from, end);
    return there && *there == crc;
  };
  if (!is_png(path) && !holds(head.table_at(), head.table_at() + 8 * state.pieces, state.table_crc)) return false;
  return state.end >= head.pieces_at && holds(head.pieces_at, state.end, state.pieces_crc);
}

}  // namespace trueshade
