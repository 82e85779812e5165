// Academy Software Foundation, "The OpenEXR File Layout" and "Technical Introduction to OpenEXR".
#include "core/image_files/exr_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "core/image_files/deflate.h"
#include "core/image_files/exr_rows.h"
#include "core/image_files/file_budget.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

constexpr int kRowsOfBlock = 16;  // rows that ZIP compresses together
constexpr uint8_t kZip = 3;       // the number of that compression
constexpr size_t kShortName = 31, kMostName = 255;
constexpr uint32_t kMagic = 0x01312f76, kVersion = 2;
constexpr size_t kFlagByte = 5;  // of the file; the lower byte of the version's flags
constexpr uint8_t kLongNames = 4;

/// The bytes of a header: attributes of a name, a type and a value each. Numbers are little-endian.
class Header {
 public:
  explicit Header(const std::string& where) : where_(where) {
    number(kMagic);
    number(kVersion);
  }

  template <typename Number>
  void number(Number value) {
    for (const uint8_t byte : std::bit_cast<std::array<uint8_t, sizeof value>>(value)) bytes_.push_back(byte);
  }
  void text(std::string_view value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }
  void name(std::string_view value) {
    if (value.empty() || value.size() > kMostName)
      throw Error(ErrorKind::usage, where_, "an EXR cannot hold the name '" + std::string(value) + "'",
                  "use 1 to 255 bytes");
    long_names_ = long_names_ || value.size() > kShortName;
    text(value);
    number(uint8_t(0));
  }
  void attribute(std::string_view key, std::string_view type, size_t bytes) {
    name(key);
    name(type);
    number(int32_t(bytes));
  }
  void string(std::string_view key, std::string_view value) {
    attribute(key, "string", value.size());
    text(value);
  }
  void box(std::string_view key, const Image& image) {
    attribute(key, "box2i", 16);
    for (const int32_t corner : {0, 0, image.width - 1, image.height - 1}) number(corner);
  }

  /// All of it, from the file's first byte to the zero that ends the attributes.
  std::vector<uint8_t> finish() {
    number(uint8_t(0));
    if (long_names_) bytes_[kFlagByte] |= kLongNames;
    return std::move(bytes_);
  }

 private:
  std::string where_;
  std::vector<uint8_t> bytes_;
  bool long_names_ = false;
};

void add_channels(std::span<const ExrChannel> channels, Header& header) {
  size_t bytes = 1;
  for (const ExrChannel& channel : channels) bytes += channel.name.size() + 17;
  header.attribute("channels", "chlist", bytes);
  for (const ExrChannel& channel : channels) {
    header.name(channel.name);
    header.number(int32_t(channel.type));
    header.number(uint32_t(0));  // not perceptually linear, and three bytes that are reserved
    header.number(int32_t(1));   // every pixel of a row has a sample, and every row
    header.number(int32_t(1));
  }
  header.number(uint8_t(0));
}

bool holds_display_codes(const Image& color, const ImageFileOptions& options) {
  const FormatInfo layout = info(color.format);
  return options.values == PictureValues::display_codes ||
         (layout.number_class == NumberClass::unorm && !layout.srgb);  // of sRGB targets, values are linear
}

std::vector<uint8_t> file_header(const std::string& where, const Image& color, std::span<const ExrChannel> channels,
                                 const Metadata& metadata, const ImageFileOptions& options) {
  Header header(where);
  add_channels(channels, header);
  header.attribute("compression", "compression", 1);
  header.number(kZip);
  header.box("dataWindow", color);
  header.box("displayWindow", color);
  header.attribute("lineOrder", "lineOrder", 1);
  header.number(uint8_t(0));  // from the top down
  header.attribute("pixelAspectRatio", "float", 4);
  header.number(1.0f);
  header.attribute("screenWindowCenter", "v2f", 8);
  header.number(0.0f);
  header.number(0.0f);
  header.attribute("screenWindowWidth", "float", 4);
  header.number(1.0f);
  header.string("Software", "trueshade");
  header.string("oiio:ColorSpace", holds_display_codes(color, options) ? "sRGB" : "Linear");
  for (const auto& [key, value] : metadata) header.string(key, value);
  return header.finish();
}

/// Memory whose pages cost nothing until they are written.
struct Buffer {
  std::unique_ptr<uint8_t[]> bytes;
  size_t size = 0;

  explicit Buffer(size_t count) : bytes(std::make_unique_for_overwrite<uint8_t[]>(count)), size(count) {}
  std::span<uint8_t> first(size_t count) const { return {bytes.get(), count}; }
};

/// ZIP's preparation: bytes at even places before those at odd ones, then each as its difference from the byte before.
/// The two halves of a block grow at once.
class Differences {
 public:
  explicit Differences(size_t bytes) : bytes_(bytes), half_(bytes / 2) {}  // a sample has an even number of bytes

  void add(std::span<const uint8_t> samples) {
    add_half(samples, 0, bytes_.bytes.get() + filled_, last_[0]);
    add_half(samples, 1, bytes_.bytes.get() + half_ + filled_, last_[1]);
    filled_ += samples.size() / 2;
  }
  /// All of the block, once it is added.
  std::span<const uint8_t> finish() {
    bytes_.bytes[half_] = uint8_t(bytes_.bytes[half_] - last_[0]);  // it stands behind the last even byte
    bytes_.bytes[0] = uint8_t(bytes_.bytes[0] - kBias);             // and the first of all behind none
    return bytes_.first(2 * half_);
  }
  void restart(size_t bytes) { half_ = bytes / 2, filled_ = 0, last_[0] = last_[1] = 0; }

 private:
  static constexpr uint8_t kBias = 128;

  static void add_half(std::span<const uint8_t> samples, size_t parity, uint8_t* out, uint8_t& last) {
    const uint8_t* const from = samples.data() + parity;
    const size_t count = samples.size() / 2;
    out[0] = uint8_t(from[0] - last + kBias);
    for (size_t i = 1; i < count; ++i) out[i] = uint8_t(from[2 * i] - from[2 * i - 2] + kBias);
    last = from[2 * count - 2];
  }

  Buffer bytes_;
  size_t half_, filled_ = 0;
  uint8_t last_[2] = {0, 0};
};

/// Makes the compressed blocks of a file, one at a time, in memory of its own.
class BlockWriter {
 public:
  BlockWriter(std::span<const ExrChannel> channels, int height)
      : rows_(channels),
        height_(height),
        samples_(rows_.row_bytes()),
        differences_(rows_.row_bytes() * size_t(std::min(height, kRowsOfBlock))) {}

  /// A block with the first of its rows and its size before it. It is stored as it is where compression does not help.
  std::vector<uint8_t> block(int index) {
    const int first = index * kRowsOfBlock, end = std::min(first + kRowsOfBlock, height_);
    const size_t bytes = rows_.row_bytes() * size_t(end - first);
    differences_.restart(bytes);
    for_samples(first, end, [this](std::span<const uint8_t> samples) { differences_.add(samples); });
    const std::span<const uint8_t> block = differences_.finish();
    std::vector<uint8_t> piece(kBlockHeader + kZlibHeader.size());
    std::copy(kZlibHeader.begin(), kZlibHeader.end(), piece.begin() + kBlockHeader);
    deflater_.append(block, Deflater::Part::last, piece);
    const std::array<uint8_t, 4> trailer = zlib_trailer(adler_of(block));
    piece.insert(piece.end(), trailer.begin(), trailer.end());
    if (piece.size() - kBlockHeader >= bytes) {
      piece.resize(kBlockHeader);
      for_samples(first, end, [&piece](auto samples) { piece.insert(piece.end(), samples.begin(), samples.end()); });
    }
    uint8_t* out = piece.data();
    for (const auto word : {uint32_t(first), uint32_t(piece.size() - kBlockHeader)})
      for (const int shift : {0, 8, 16, 24}) *out++ = uint8_t(word >> shift);
    return piece;
  }

 private:
  static constexpr size_t kBlockHeader = 8;

  /// The samples of rows, in the order in which a block has them.
  template <typename Take>
  void for_samples(int first, int end, Take take) {
    for (int y = first; y < end; ++y)
      for (const ExrChannel& channel : rows_.channels()) {
        const std::span<uint8_t> samples = samples_.first(rows_.channel_bytes(channel));
        rows_.pack(channel, y, samples.data());
        take(std::span<const uint8_t>(samples));
      }
  }

  ExrRows rows_;
  int height_;
  Buffer samples_;  ///< of a channel in a row
  Differences differences_;
  Deflater deflater_;
};

/// Where each block begins in the file.
std::vector<uint8_t> offset_table(size_t header_bytes, std::span<const std::vector<uint8_t>> blocks) {
  std::vector<uint8_t> table;
  uint64_t at = header_bytes + 8 * blocks.size();
  for (const std::vector<uint8_t>& block : blocks) {
    for (int shift = 0; shift < 64; shift += 8) table.push_back(uint8_t(at >> shift));
    at += block.size();
  }
  return table;
}

}  // namespace

std::vector<std::vector<uint8_t>> exr_file(const std::string& where, const Image& color,
                                           std::span<const NamedImage> aovs, const Metadata& metadata,
                                           const ImageFileOptions& options) {
  if (color.width < 1 || color.height < 1)
    throw Error(ErrorKind::usage, where, "an EXR has pixels", "write another image");
  const std::vector<ExrChannel> channels = exr_channels(where, color, aovs);
  const int blocks = (color.height + kRowsOfBlock - 1) / kRowsOfBlock;
  std::vector<std::vector<uint8_t>> pieces(2 + size_t(blocks));
  pieces[0] = file_header(where, color, channels, metadata, options);
  FileBudget budget(where);
  std::atomic<int> next{0};
  const int writers = std::min(thread_count(options.threads), blocks);
  parallel_for(writers, writers, [&](int) {
    BlockWriter writer(channels, color.height);
    for (int i = next++; i < blocks; i = next++) {
      pieces[2 + size_t(i)] = writer.block(i);
      budget.take(pieces[2 + size_t(i)].size());
    }
  });
  pieces[1] = offset_table(pieces[0].size(), std::span(pieces).subspan(2));
  return pieces;
}

}  // namespace trueshade
