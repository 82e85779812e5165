// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 5.3, 9 and 10.
#include "core/png_pixels.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/error.h"

namespace trueshade {
namespace {

constexpr size_t kSignatureBytes = 8, kChunkOverhead = 12;  // a chunk: length, type, data, CRC
constexpr size_t kPiece = 65536;

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 | uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

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
              size_t texel) {
  if (filter > 4) throw refused(where, "a row has a filter that PNG does not know");
  for (size_t i = 0; i < bytes; ++i) {
    const int left = i < texel ? 0 : row[i - texel];
    const int up = above == nullptr ? 0 : above[i];
    const int corner = i < texel || above == nullptr ? 0 : above[i - texel];
    const int guess = filter == 1   ? left
                      : filter == 2 ? up
                      : filter == 3 ? (left + up) / 2
                      : filter == 4 ? paeth(left, up, corner)
                                    : 0;
    row[i] = uint8_t(row[i] + guess);
  }
}

void check_kind(const std::string& where, std::span<const uint8_t> header) {
  if ((header[8] != 8 && header[8] != 16) || header[9] != 6)
    throw refused(where, "its texels are not RGBA of 8 or 16 bits", "write RGBA: alpha is judged too");
  if (header[10] != 0 || header[11] != 0 || header[12] != 0)
    throw refused(where, "it is interlaced, or compressed in an unknown way", "write it without interlacing");
}

}  // namespace

Image png_pixels(const std::string& where, std::span<const uint8_t> bytes) {
  std::unique_ptr<Inflater> texels;
  Image image;
  for (size_t at = kSignatureBytes; at + kChunkOverhead <= bytes.size();) {
    const size_t length = word_at(bytes, at);
    const std::span<const uint8_t> type = bytes.subspan(at + 4, 4), data = bytes.subspan(at + 8, length);
    if (crc32(0, type.data(), uInt(4 + length)) != word_at(bytes, at + 8 + length))
      throw refused(where, "a checksum of it is wrong");
    const std::string name(type.begin(), type.end());
    if (name == "IHDR") {
      check_kind(where, data);
      image.format = data[8] == 16 ? Format::rgba16 : Format::rgba8;
      image.width = int(word_at(data, 0)), image.height = int(word_at(data, 4));
      texels = std::make_unique<Inflater>(where, (image.row_bytes() + 1) * size_t(image.height));
    } else if (name == "IDAT") {
      texels->add(data);
    } else if (name == "IEND") {
      break;
    }
    at += length + kChunkOverhead;
  }
  std::vector<uint8_t> rows = texels->finish();
  const size_t row_bytes = image.row_bytes();
  const auto texel_bytes = size_t(info(image.format).bytes_per_texel());
  image.texels.resize(row_bytes * size_t(image.height));
  const uint8_t* above = nullptr;
  for (int y = 0; y < image.height; ++y) {
    uint8_t* row = rows.data() + size_t(y) * (row_bytes + 1);
    unfilter(where, row[0], row + 1, above, row_bytes, texel_bytes);
    std::copy(row + 1, row + 1 + row_bytes, image.texel(0, y));
    above = row + 1;
  }
  if (image.format == Format::rgba16)  // most significant byte first, in the file
    for (size_t i = 0; i < image.texels.size(); i += 2) std::swap(image.texels[i], image.texels[i + 1]);
  return image;
}

}  // namespace trueshade
