// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5.3, 10 and 11.
#include "core/image_files/png_pixels.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_rows.h"

namespace trueshade {
namespace {

Error refused(const std::string& where, const char* reason) {
  return {ErrorKind::bad_input, where, reason, "write the file again"};
}

/// What is done with the texels of a PNG.
enum class Texels : uint8_t { kept, passed_over };

/// Makes an image of the compressed rows of a PNG, row by row as they come; where texels are passed over, of the height
/// of a row, which each row is put into.
class RowDecoder {
 public:
  RowDecoder(const std::string& where, const PngLayout& layout, const PngColors& colors, Texels texels)
      : where_(where),
        layout_(layout),
        colors_(colors),
        passes_(png_passes(layout)),
        texels_(texels),
        image_(layout.width, texels == Texels::kept ? layout.height : 1,
               layout.bits == 16 ? Format::rgba16 : Format::rgba8) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
    begin_pass();
  }
  ~RowDecoder() { inflateEnd(&stream_); }
  RowDecoder(const RowDecoder&) = delete;
  RowDecoder& operator=(const RowDecoder&) = delete;

  void add(std::span<const uint8_t> data) {
    stream_.next_in = const_cast<Bytef*>(data.data());  // zlib reads it only
    stream_.avail_in = uInt(data.size());               // a PNG chunk is below 2^31
    while (!ended_) {
      uint8_t beyond;  // behind the last row there is nothing
      const bool full = passes_.empty();
      stream_.next_out = full ? &beyond : row_.data() + filled_;
      const uInt room = full ? 1 : uInt(row_.size() - filled_);
      stream_.avail_out = room;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      ended_ = status == Z_STREAM_END;
      if (status != Z_OK && status != Z_BUF_ERROR && !ended_)
        throw refused(where_, "its compressed texels are damaged");
      const size_t made = room - stream_.avail_out;
      if (full && made > 0) throw refused(where_, "it holds more texels than its header says");
      filled_ += full ? 0 : made;
      if (!full && filled_ == row_.size()) finish_row();
      if (stream_.avail_in == 0 && made < room) return;
    }
  }
  Image finish() {
    if (!ended_ || !passes_.empty()) throw refused(where_, "it holds fewer texels than its header says");
    return std::move(image_);
  }

 private:
  /// Goes to the next pass that has pixels; an interlaced picture of few pixels has passes without any.
  void begin_pass() {
    while (!passes_.empty() && (passes_[0].columns(layout_) == 0 || passes_[0].rows(layout_) == 0))
      passes_ = passes_.subspan(1);
    if (passes_.empty()) return;
    y_ = 0, filled_ = 0;
    row_.assign(1 + layout_.row_bytes(passes_[0].columns(layout_)), 0);  // behind the byte that names its filter
    above_.assign(row_.size(), 0);
  }

  void finish_row() {
    const PngPass& pass = passes_[0];
    const std::span<uint8_t> row = std::span(row_).subspan(1);
    if (!undo_png_filter(row_[0], row, std::span(above_).subspan(1), layout_.texel_bytes()))
      throw refused(where_, "a row has a filter that PNG does not know");
    uint8_t* const out = image_.texel(pass.x0, texels_ == Texels::kept ? pass.y0 + y_ * pass.dy : 0);
    if (!png_row_as_rgba(layout_, colors_, row, pass.columns(layout_), size_t(pass.dx), out))
      throw refused(where_, "a texel is beyond its palette");
    std::swap(row_, above_);
    filled_ = 0;
    if (++y_ < pass.rows(layout_)) return;
    passes_ = passes_.subspan(1);
    begin_pass();
  }

  const std::string& where_;
  const PngLayout& layout_;
  const PngColors& colors_;
  std::span<const PngPass> passes_;  ///< those to come, the one at work first
  const Texels texels_;
  Image image_;
  z_stream stream_{};
  std::vector<uint8_t> row_, above_;
  size_t filled_ = 0;  ///< bytes of row_
  int y_ = 0;          ///< row of the pass
  bool ended_ = false;
};

PngLayout layout_of(const std::string& where, std::span<const uint8_t> header) {
  if (header[10] != 0 || header[11] != 0 || header[12] > 1)
    throw refused(where, "it is compressed, filtered or interlaced in a way that PNG does not know");
  return {int(png_word_at(header, 0)), int(png_word_at(header, 4)), header[9], header[8], header[12] == 1};
}

void set_palette(const std::string& where, std::span<const uint8_t> data, PngColors& colors) {
  if (data.empty() || data.size() % 3 != 0 || data.size() > 768) throw refused(where, "its palette is damaged");
  colors.palette_size = data.size() / 3;
  for (size_t i = 0; i < colors.palette_size; ++i) {
    std::copy_n(data.data() + 3 * i, 3, colors.palette[i]);
    colors.palette[i][3] = 255;
  }
}

/// Alphas of a palette, or the one colour that stands for transparency.
void set_transparency(const std::string& where, std::span<const uint8_t> data, const PngLayout& layout,
                      PngColors& colors) {
  constexpr uint8_t kPalette = 3;
  if (layout.color_type == kPalette) {
    if (data.size() > colors.palette_size) throw refused(where, "its palette has too many alphas");
    for (size_t i = 0; i < data.size(); ++i) colors.palette[i][3] = data[i];
    return;
  }
  if (layout.color_type > 2) throw refused(where, "it has an alpha channel and a colour that stands for transparency");
  if (data.size() != 2 * layout.channels()) throw refused(where, "its colour that stands for transparency is damaged");
  for (size_t c = 0; c < layout.channels(); ++c)
    colors.key[c] = uint16_t((data[2 * c] << 8 | data[2 * c + 1]) & ((1 << layout.bits) - 1));
}

Image decoded_rows(const std::string& where, std::span<const uint8_t> bytes, Texels texels) {
  PngLayout layout;
  PngColors colors;
  std::optional<RowDecoder> rows;
  for (size_t at = kPngSignatureBytes; at + kPngChunkOverhead <= bytes.size();) {
    const size_t length = png_word_at(bytes, at);
    const std::span<const uint8_t> type = bytes.subspan(at + 4, 4), data = bytes.subspan(at + 8, length);
    if (crc32(0, type.data(), uInt(4 + length)) != png_word_at(bytes, at + 8 + length))
      throw refused(where, "a checksum of it is wrong");
    const std::string name(type.begin(), type.end());
    if (name == "IHDR") {
      layout = layout_of(where, data);
    } else if (name == "PLTE" && layout.color_type == 3) {
      set_palette(where, data, colors);
    } else if (name == "tRNS") {
      set_transparency(where, data, layout, colors);
    } else if (name == "IDAT") {
      if (!rows) rows.emplace(where, layout, colors, texels);
      rows->add(data);
    } else if (name == "IEND") {
      break;
    }
    at += length + kPngChunkOverhead;
  }
  if (!rows) throw refused(where, "it holds fewer texels than its header says");
  return rows->finish();
}

}  // namespace

Image png_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  return decoded_rows(where, bytes, Texels::kept);
}

void check_png_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  decoded_rows(where, bytes, Texels::passed_over);
}

}  // namespace trueshade
