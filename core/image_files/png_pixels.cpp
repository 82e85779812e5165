// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5.3, 9 and 10.
#include "core/image_files/png_pixels.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/image_files/png_header.h"

namespace trueshade {
namespace {

constexpr size_t kPiece = 65536;

Error refused(const std::string& where, const char* reason, const char* remedy = "write the file again") {
  return {ErrorKind::bad_input, where, reason, remedy};
}

/// zlib's inflate of a stream given piece by piece, to no more than `most` bytes.
class Inflater {
 public:
  Inflater(const std::string& where, size_t most) : where_(where), most_(most) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  void add(std::span<const uint8_t> data) {
    stream_.next_in = const_cast<Bytef*>(data.data());  // zlib reads it only
    stream_.avail_in = uInt(data.size());               // a PNG chunk is below 2^31
    while (stream_.avail_in > 0 && !ended_) {
      const size_t before = out_.size();
      out_.resize(before + kPiece);
      stream_.next_out = out_.data() + before;
      stream_.avail_out = uInt(kPiece);
      const int status = inflate(&stream_, Z_NO_FLUSH);
      out_.resize(before + kPiece - stream_.avail_out);
      ended_ = status == Z_STREAM_END;
      if (status != Z_OK && !ended_) throw refused(where_, "its compressed texels are damaged");
      if (out_.size() > most_) throw refused(where_, "it holds more texels than its header says");
    }
  }
  std::vector<uint8_t> finish() {
    if (!ended_ || out_.size() != most_) throw refused(where_, "it holds fewer texels than its header says");
    return std::move(out_);
  }

 private:
  std::string where_;
  size_t most_;
  z_stream stream_{};
  std::vector<uint8_t> out_;
  bool ended_ = false;
};

int paeth(int left, int above, int corner) {
  const int estimate = left + above - corner;
  const int a = std::abs(estimate - left), b = std::abs(estimate - above), c = std::abs(estimate - corner);
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

/// Undoes a row's filter in place. `above`: the row before it, undone; null for the first.
void unfilter(const std::string& where, uint8_t filter, uint8_t* row, const uint8_t* above, size_t bytes,
              size_t texel_bytes) {
  if (filter > 4) throw refused(where, "a row has a filter that PNG does not know");
  for (size_t i = 0; i < bytes; ++i) {
    const int left = i < texel_bytes ? 0 : row[i - texel_bytes];
    const int up = above == nullptr ? 0 : above[i];
    const int corner = i < texel_bytes || above == nullptr ? 0 : above[i - texel_bytes];
    const int guess = filter == 1   ? left
                      : filter == 2 ? up
                      : filter == 3 ? (left + up) / 2
                      : filter == 4 ? paeth(left, up, corner)
                                    : 0;
    row[i] = uint8_t(row[i] + guess);
  }
}

enum Kind : uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };  // PNG's colour types

/// Channels of a texel in the file; of a palette the index.
int channels_of(uint8_t kind) { return kind == kRgba ? 4 : kind == kRgb ? 3 : kind == kGreyAlpha ? 2 : 1; }

void check_kind(const std::string& where, std::span<const uint8_t> header, PngDepths depths) {
  const int bits = header[8];
  if (depths == PngDepths::of_8 && bits != 8)
    throw refused(where, "its channels are not of 8 bits", "write 8 bits a channel");
  if (bits != 8 && (bits != 16 || header[9] == kPalette))
    throw refused(where, "its channels are not of 8 or 16 bits", "write 8 or 16 bits a channel");
  if (header[10] != 0 || header[11] != 0 || header[12] != 0)
    throw refused(where, "it is interlaced, or compressed in an unknown way", "write it without interlacing");
}

struct Palette {
  uint8_t rgba[256][4] = {};
  size_t size = 0;

  void set_colors(const std::string& where, std::span<const uint8_t> data) {
    if (data.empty() || data.size() % 3 != 0 || data.size() > 768) throw refused(where, "its palette is damaged");
    size = data.size() / 3;
    for (size_t i = 0; i < size; ++i) {
      std::copy_n(data.data() + 3 * i, 3, rgba[i]);
      rgba[i][3] = 255;
    }
  }
  void set_alphas(const std::string& where, std::span<const uint8_t> data) {
    if (data.size() > size) throw refused(where, "its palette has too many alphas");
    for (size_t i = 0; i < data.size(); ++i) rgba[i][3] = data[i];
  }
};

/// A row of any kind as RGBA: grey spread over R, G and B, the largest alpha where there is none.
void spread(const std::string& where, uint8_t kind, size_t code_bytes, const Palette& palette, const uint8_t* row,
            size_t width, uint8_t* out) {
  const size_t channels = size_t(channels_of(kind));
  const bool color = kind == kRgb || kind == kRgba, alpha = kind == kRgba || kind == kGreyAlpha;
  for (size_t x = 0; x < width; ++x, row += channels * code_bytes, out += 4 * code_bytes) {
    if (kind == kPalette) {
      if (*row >= palette.size) throw refused(where, "a texel is beyond its palette");
      std::copy_n(palette.rgba[*row], 4, out);
      continue;
    }
    for (size_t c = 0; c < 3; ++c) std::copy_n(row + (color ? c * code_bytes : 0), code_bytes, out + c * code_bytes);
    if (alpha)
      std::copy_n(row + (channels - 1) * code_bytes, code_bytes, out + 3 * code_bytes);
    else
      std::fill_n(out + 3 * code_bytes, code_bytes, uint8_t(255));
  }
}

/// What the chunks of a PNG hold.
struct Contents {
  int width = 0, height = 0;
  uint8_t kind = kRgba;
  size_t code_bytes = 1;  ///< of a channel
  Palette palette;
  std::vector<uint8_t> rows;  ///< each behind the byte that names its filter

  size_t texel_bytes() const { return size_t(channels_of(kind)) * code_bytes; }
  size_t row_bytes() const { return size_t(width) * texel_bytes(); }
};

Contents contents_of(const std::string& where, std::span<const uint8_t> bytes, PngDepths depths) {
  std::unique_ptr<Inflater> texels;
  Contents png;
  for (size_t at = kPngSignatureBytes; at + kPngChunkOverhead <= bytes.size();) {
    const size_t length = png_word_at(bytes, at);
    const std::span<const uint8_t> type = bytes.subspan(at + 4, 4), data = bytes.subspan(at + 8, length);
    if (crc32(0, type.data(), uInt(4 + length)) != png_word_at(bytes, at + 8 + length))
      throw refused(where, "a checksum of it is wrong");
    const std::string name(type.begin(), type.end());
    if (name == "IHDR") {
      check_kind(where, data, depths);
      png.kind = data[9], png.code_bytes = data[8] / 8;
      png.width = int(png_word_at(data, 0)), png.height = int(png_word_at(data, 4));
      texels = std::make_unique<Inflater>(where, (png.row_bytes() + 1) * size_t(png.height));
    } else if (name == "PLTE" && png.kind == kPalette) {
      png.palette.set_colors(where, data);
    } else if (name == "tRNS" && png.kind != kRgba) {
      if (png.kind != kPalette) throw refused(where, "one of its colours stands for transparency", "write RGBA");
      png.palette.set_alphas(where, data);
    } else if (name == "IDAT") {
      texels->add(data);
    } else if (name == "IEND") {
      break;
    }
    at += length + kPngChunkOverhead;
  }
  png.rows = texels->finish();
  return png;
}

}  // namespace

Image png_pixels(const std::string& where, std::span<const uint8_t> bytes, PngDepths depths) {
  Contents png = contents_of(where, bytes, depths);
  Image image(png.width, png.height, png.code_bytes == 2 ? Format::rgba16 : Format::rgba8);
  const size_t row_bytes = png.row_bytes();
  const uint8_t* above = nullptr;
  for (int y = 0; y < png.height; ++y) {
    uint8_t* row = png.rows.data() + size_t(y) * (row_bytes + 1);
    unfilter(where, row[0], row + 1, above, row_bytes, png.texel_bytes());
    spread(where, png.kind, png.code_bytes, png.palette, row + 1, size_t(png.width), image.texel(0, y));
    above = row + 1;
  }
  std::vector<uint8_t>& texels = image.texels;
  if (png.code_bytes == 2)  // the file has the more significant byte first
    for (size_t i = 0; i < texels.size(); i += 2) std::swap(texels[i], texels[i + 1]);
  return image;
}

}  // namespace trueshade
