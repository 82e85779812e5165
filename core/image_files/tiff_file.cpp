// Adobe, "TIFF, Revision 6.0", 1992: sections 2, 8, 14 and 15; "Adobe Photoshop TIFF Technical Notes", 2002: Deflate;
// the third predictor is that of "Adobe Photoshop TIFF Technical Note 3", 2005.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/half.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"

namespace trueshade {
namespace {

constexpr uint32_t kMostTiffChannels = 64, kMostTiffTags = 512;

enum TiffTag : uint16_t {
  kTiffWidth = 256,
  kTiffHeight = 257,
  kTiffBits = 258,
  kTiffCompression = 259,
  kTiffPhotometric = 262,
  kTiffStripOffsets = 273,
  kTiffOrientation = 274,
  kTiffSamples = 277,
  kTiffStripRows = 278,
  kTiffStripBytes = 279,
  kTiffPlanar = 284,
  kTiffPredictor = 317,
  kTiffTileWidth = 322,
  kTiffTileHeight = 323,
  kTiffTileOffsets = 324,
  kTiffTileBytes = 325,
  kTiffSampleFormat = 339
};

/// A TIFF's directory, each number checked against the file's end.
class TiffFile {
 public:
  TiffFile(const std::string& where, std::span<const uint8_t> bytes) : where_(where), bytes_(bytes) {
    if (bytes.size() < 8) fail("it ends inside its header");
    big_endian_ = bytes[0] == 'M';
    const uint64_t directory = number(4, 4);
    const uint64_t count = number(directory, 2);
    if (count > kMostTiffTags) fail("its directory has over 512 entries");
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t at = directory + 2 + 12 * i;
      entries_.emplace(uint16_t(number(at, 2)), at);
    }
    if (number(directory + 2 + 12 * count, 4) != 0) fail("it has several pages", "save one page");
  }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = "write the file again") const {
    throw Error(ErrorKind::bad_input, where_, reason, remedy);
  }
  std::span<const uint8_t> part(uint64_t at, uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) fail("the TIFF ends before its data do");
    return bytes_.subspan(size_t(at), size_t(size));
  }
  uint64_t number(uint64_t at, size_t size) const {
    const std::span<const uint8_t> digits = part(at, size);
    uint64_t value = 0;
    for (size_t k = 0; k < size; ++k) value |= uint64_t(digits[big_endian_ ? size - 1 - k : k]) << (8 * k);
    return value;
  }
  bool big_endian() const { return big_endian_; }

  uint64_t count(TiffTag tag) const {
    const auto entry = entries_.find(tag);
    return entry == entries_.end() ? 0 : number(entry->second + 4, 4);
  }
  /// Element `index` of a tag's numbers (SHORT or LONG).
  uint64_t value(TiffTag tag, uint64_t index, uint64_t absent) const {
    const auto entry = entries_.find(tag);
    if (entry == entries_.end()) return absent;
    const uint64_t type = number(entry->second + 2, 2), of = number(entry->second + 4, 4);
    if (type != 3 && type != 4) fail("its tag " + std::to_string(int(tag)) + " is of another type than numbers");
    const size_t size = type == 3 ? 2 : 4;
    if (index >= of) fail("its tag " + std::to_string(int(tag)) + " has too few numbers");
    const bool inside = of * size <= 4;
    return number((inside ? entry->second + 8 : number(entry->second + 8, 4)) + index * size, size);
  }

 private:
  const std::string& where_;
  std::span<const uint8_t> bytes_;
  bool big_endian_ = false;
  std::map<uint16_t, uint64_t> entries_;
};

/// How the texels lie.
struct TiffLayout {
  uint64_t width, height, channels, sample_bytes;
  ChannelKind kind;
  bool apart;  ///< each channel by itself: PlanarConfiguration 2
  bool tiled;
  uint64_t block_width, block_height;
  uint64_t compression, predictor;
  uint64_t block_channels() const { return apart ? 1 : channels; }
  uint64_t across() const { return (width + block_width - 1) / block_width; }
  uint64_t down() const { return (height + block_height - 1) / block_height; }
};

ChannelKind tiff_kind(const TiffFile& tiff, uint64_t bits) {
  const uint64_t format = tiff.value(kTiffSampleFormat, 0, 1);
  for (uint64_t i = 1; i < tiff.count(kTiffSampleFormat); ++i)
    if (tiff.value(kTiffSampleFormat, i, 1) != format) tiff.fail("its channels have two types", "save them in one");
  if (format == 1 && (bits == 8 || bits == 16)) return ChannelKind::unorm;
  if (format == 1 && bits == 32) return ChannelKind::integer;
  if (format == 3 && (bits == 16 || bits == 32 || bits == 64)) return ChannelKind::floating;
  tiff.fail("its channels have " + std::to_string(bits) + " bits of format " + std::to_string(format),
            "save 8 or 16 bits, floats, or unsigned integers of 32 bits");
}

TiffLayout tiff_layout(const std::string& where, const TiffFile& tiff) {
  TiffLayout t{};
  t.width = tiff.value(kTiffWidth, 0, 0), t.height = tiff.value(kTiffHeight, 0, 0);
  t.channels = tiff.value(kTiffSamples, 0, 1);
  if (t.channels < 1 || t.channels > kMostTiffChannels) tiff.fail("it has no channels, or over 64");
  check_size(where, int(std::min<uint64_t>(t.width, 1 << 30)), int(std::min<uint64_t>(t.height, 1 << 30)));
  const uint64_t bits = tiff.value(kTiffBits, 0, 1);
  for (uint64_t i = 1; i < std::min(tiff.count(kTiffBits), t.channels); ++i)
    if (tiff.value(kTiffBits, i, bits) != bits) tiff.fail("its channels have two sizes", "save them in one");
  t.kind = tiff_kind(tiff, bits);
  t.sample_bytes = bits / 8;
  t.compression = tiff.value(kTiffCompression, 0, 1);
  if (t.compression != 1 && t.compression != 8 && t.compression != 32946)
    tiff.fail("its compression " + std::to_string(t.compression) + " is not read",
              "save it uncompressed, or by Deflate");
  t.predictor = tiff.value(kTiffPredictor, 0, 1);
  const bool floats = t.kind == ChannelKind::floating;
  if (t.predictor > 3 || t.predictor < 1 || (t.predictor == 2 && floats) || (t.predictor == 3 && !floats))
    tiff.fail("its predictor is not read", "save it without one");
  const uint64_t photometric = tiff.value(kTiffPhotometric, 0, 1);
  if (photometric != 1 && photometric != 2) tiff.fail("it holds neither grey nor RGB", "save RGB");
  if (tiff.value(kTiffOrientation, 0, 1) != 1) tiff.fail("its rows do not run from the top", "save it upright");
  const uint64_t planar = tiff.value(kTiffPlanar, 0, 1);
  t.apart = planar == 2 && t.channels > 1;
  t.tiled = tiff.count(kTiffTileOffsets) > 0;
  t.block_width = t.tiled ? tiff.value(kTiffTileWidth, 0, 0) : t.width;
  t.block_height =
      t.tiled ? tiff.value(kTiffTileHeight, 0, 0) : std::min(tiff.value(kTiffStripRows, 0, t.height), t.height);
  if (t.block_width < 1 || t.block_height < 1 || t.block_width > kMaxSide || t.block_height > kMaxSide)
    tiff.fail("its strips or tiles have no size");
  return t;
}

/// The bytes of a strip or tile, unpacked.
std::vector<uint8_t> tiff_block(const TiffFile& tiff, const TiffLayout& t, uint64_t index, uint64_t rows) {
  const std::span<const uint8_t> packed =
      tiff.part(tiff.value(t.tiled ? kTiffTileOffsets : kTiffStripOffsets, index, 0),
                tiff.value(t.tiled ? kTiffTileBytes : kTiffStripBytes, index, 0));
  const uint64_t size = t.block_width * rows * t.block_channels() * t.sample_bytes;
  if (t.compression == 1) {
    if (packed.size() != size) tiff.fail("a strip or tile of it has another size than its texels");
    return {packed.begin(), packed.end()};
  }
  if (size / 1032 > packed.size() + 16) tiff.fail("a strip or tile of it ends early");  // Deflate's largest expansion
  std::vector<uint8_t> bytes(size);
  uLongf made = uLongf(size);
  uLong taken = uLong(packed.size());
  if (uncompress2(bytes.data(), &made, packed.data(), &taken) != Z_OK || made != size)
    tiff.fail("a strip or tile of it cannot be unpacked");
  return bytes;
}

uint64_t tiff_sample(const uint8_t* at, uint64_t size, bool big_endian) {
  uint64_t value = 0;
  for (uint64_t k = 0; k < size; ++k) value |= uint64_t(at[big_endian ? size - 1 - k : k]) << (8 * k);
  return value;
}

/// Undoes the predictor in a row of a strip or tile, and leaves its samples in the file's order of bytes; of floats
/// that were predicted, highest byte first.
void undo_prediction(const TiffLayout& t, bool big_endian, uint8_t* row, std::vector<uint8_t>& scratch) {
  const uint64_t step = t.block_channels(), count = t.block_width * step, size = t.sample_bytes;
  if (t.predictor == 2)
    for (uint64_t i = step; i < count; ++i) {
      const uint64_t value =
          tiff_sample(row + i * size, size, big_endian) + tiff_sample(row + (i - step) * size, size, big_endian);
      for (uint64_t k = 0; k < size; ++k) row[i * size + (big_endian ? size - 1 - k : k)] = uint8_t(value >> (8 * k));
    }
  if (t.predictor != 3) return;
  for (uint64_t i = step; i < count * size; ++i) row[i] = uint8_t(row[i] + row[i - step]);
  scratch.assign(row, row + count * size);
  for (uint64_t i = 0; i < count; ++i)
    for (uint64_t k = 0; k < size; ++k) row[i * size + k] = scratch[k * count + i];
}

uint32_t tiff_word(uint64_t sample, const TiffLayout& t, bool& is_rounded) {
  if (t.kind != ChannelKind::floating || t.sample_bytes == 4) return uint32_t(sample);
  if (t.sample_bytes == 2) return std::bit_cast<uint32_t>(float_from_half(uint16_t(sample)));
  const double value = std::bit_cast<double>(sample);
  const double most = 3.4028234663852886e38;
  const float near = value > most ? INFINITY : value < -most ? -INFINITY : float(value);
  is_rounded = is_rounded || (std::isfinite(value) && double(near) != value);
  return std::bit_cast<uint32_t>(near);
}

/// Puts a strip's or tile's samples into their channels.
void place_block(const TiffFile& tiff, const TiffLayout& t, uint64_t index, ChannelFile& file) {
  const uint64_t in_plane = t.across() * t.down(), plane = index / in_plane, at = index % in_plane;
  const uint64_t left = at % t.across() * t.block_width, top = at / t.across() * t.block_height;
  const uint64_t rows = t.tiled ? t.block_height : std::min(t.block_height, t.height - top);
  std::vector<uint8_t> bytes = tiff_block(tiff, t, index, rows), scratch;
  const uint64_t step = t.block_channels(), size = t.sample_bytes, row_bytes = t.block_width * step * size;
  const bool big_endian = tiff.big_endian() || t.predictor == 3;
  for (uint64_t y = 0; y < std::min(rows, t.height - top); ++y) {
    uint8_t* const row = bytes.data() + y * row_bytes;
    undo_prediction(t, tiff.big_endian(), row, scratch);
    for (uint64_t x = 0; x < std::min(t.block_width, t.width - left); ++x)
      for (uint64_t c = 0; c < step; ++c) {
        Channel& channel = file.channels[t.apart ? plane : c];
        const uint64_t sample = tiff_sample(row + (x * step + c) * size, size, big_endian);
        channel.words[(top + y) * t.width + left + x] = tiff_word(sample, t, channel.is_rounded);
      }
  }
}

}  // namespace

ChannelFile tiff_channels(const std::string& where, std::span<const uint8_t> bytes) {
  const TiffFile tiff(where, bytes);
  const TiffLayout t = tiff_layout(where, tiff);
  const uint64_t blocks = t.across() * t.down() * (t.apart ? t.channels : 1);
  const TiffTag offsets = t.tiled ? kTiffTileOffsets : kTiffStripOffsets;
  const TiffTag sizes = t.tiled ? kTiffTileBytes : kTiffStripBytes;
  if (tiff.count(offsets) != blocks || tiff.count(sizes) != blocks)
    tiff.fail("it has another number of strips or tiles than its size needs");
  uint64_t packed = 0;
  for (uint64_t i = 0; i < blocks; ++i) packed += tiff.value(sizes, i, 0);
  const uint64_t decoded = t.width * t.height * t.channels * t.sample_bytes;
  if (decoded / 1032 > packed + 16 || (t.compression == 1 && packed < decoded))
    tiff.fail("the TIFF ends before its data do");
  require_memory(4 * t.width * t.height * t.channels, where, "the picture");
  ChannelFile file{where, int(t.width), int(t.height), {}};
  for (size_t c = 0; c < t.channels; ++c) {
    Channel channel;
    channel.name = channel_name(c, t.channels);
    channel.kind = t.kind;
    channel.bits = int(8 * t.sample_bytes);
    channel.words.resize(t.width * t.height);
    file.channels.push_back(std::move(channel));
  }
  for (uint64_t i = 0; i < blocks; ++i) place_block(tiff, t, i, file);
  return file;
}

}  // namespace trueshade
