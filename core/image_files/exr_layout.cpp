// Academy Software Foundation, "The OpenEXR File Layout": version field, header attributes, offset tables.
#include "core/image_files/exr_layout.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/image_files/size_limits.h"

namespace trueshade {
namespace {

constexpr uint32_t kTiledFlag = 0x200, kLongNamesFlag = 0x400, kDeepFlag = 0x800,
                   kPartsFlag = 0x1000;  // flags beside the version
constexpr size_t kMostNameBytes = 255, kMostChannels = 1024, kMostParts = 64;
constexpr uint64_t kMostManifest = uint64_t(16) << 20;

/// Numbers and names one after another; each is checked against the end.
class HeaderCursor {
 public:
  HeaderCursor(const std::string& where, std::span<const uint8_t> bytes, size_t at, size_t end)
      : where_(where), bytes_(bytes), at_(at), end_(end) {}

  size_t at() const { return at_; }
  size_t left() const { return end_ - at_; }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = "write the file again") const {
    throw Error(ErrorKind::bad_input, where_ + ": byte " + std::to_string(at_), reason, remedy);
  }

  uint8_t byte() {
    if (left() < 1) fail("the EXR ends inside its header");
    return bytes_[at_++];
  }
  uint32_t word() {
    uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= uint32_t(byte()) << shift;
    return value;
  }
  int32_t number() { return int32_t(word()); }

  /// Up to a zero, which is passed; empty at once at a zero.
  std::string_view name() {
    const auto begin = bytes_.begin() + std::ptrdiff_t(at_),
               end = begin + std::ptrdiff_t(std::min(left(), kMostNameBytes + 1));
    const auto zero = std::find(begin, end, uint8_t(0));
    if (zero == end) fail("a name in its header has no end");
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data() + at_), size_t(zero - begin));
    at_ += text.size() + 1;
    return text;
  }
  /// Passes a zero, if one is next.
  bool take_zero() {
    if (left() < 1) fail("the EXR ends inside its header");
    if (bytes_[at_] != 0) return false;
    ++at_;
    return true;
  }
  void skip(size_t count) {
    if (count > left()) fail("a part of its header is longer than the file");
    at_ += count;
  }
  /// The next `count` bytes by themselves, which are passed here.
  HeaderCursor part(size_t count) {
    const size_t begin = at_;
    skip(count);
    return {where_, bytes_, begin, begin + count};
  }

 private:
  const std::string& where_;
  std::span<const uint8_t> bytes_;
  size_t at_, end_;
};

struct PixelWindow {
  int64_t width, height;
};

PixelWindow read_window(HeaderCursor value) {
  const int64_t x0 = value.number(), y0 = value.number(), x1 = value.number(), y1 = value.number();
  if (x1 < x0 || y1 < y0) value.fail("a window in its header is empty");
  return {x1 - x0 + 1, y1 - y0 + 1};
}

/// Bytes of a pixel.
size_t read_channels(HeaderCursor value) {
  size_t bytes = 0;
  for (size_t count = 0;; ++count) {
    const std::string_view name = value.name();
    if (name.empty()) return bytes;
    if (count == kMostChannels) value.fail("it has over 1024 channels", "store fewer");
    const int32_t type = value.number();
    if (type < 0 || type > 2) value.fail("a channel has a type that EXR does not know");
    bytes += type == 1 ? 2 : 4;
    value.skip(4);
    if (value.number() != 1 || value.number() != 1) value.fail("a channel is subsampled", "store all its pixels");
  }
}

/// Lengths inside the values of attributes, for which OpenEXR takes memory as well.
void check_value(std::string_view type, HeaderCursor value) {
  if (type == "preview") {
    const uint64_t width = value.word(), height = value.word();
    if (width > 0xffff || height > 0xffff || 4 * width * height != value.left())
      value.fail("its preview has another size than it says");
  } else if (type == "stringvector") {
    while (value.left() > 0) value.skip(value.word());
  } else if (type == "idmanifest") {
    if (value.word() > kMostManifest) value.fail("its manifest is over 16 MiB", "leave it out");
  }
}

/// Rows that a compression packs together, by its number.
int64_t rows_of_block(uint8_t compression) {
  constexpr int64_t kRows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return compression < std::size(kRows) ? kRows[compression] : 0;
}

/// What of the header is needed.
struct HeaderValues {
  std::optional<PixelWindow> data_window, tile;
  std::optional<size_t> pixel_bytes;
  std::optional<int64_t> block_rows;
};

HeaderValues read_attributes(HeaderCursor& file) {
  HeaderValues header;
  for (std::string_view name = file.name(); !name.empty(); name = file.name()) {
    const std::string_view type = file.name();
    const uint32_t size = file.word();
    const HeaderCursor value = file.part(size);
    check_value(type, value);
    if (name == "channels" && type == "chlist") header.pixel_bytes = read_channels(value);
    if (name == "dataWindow" && type == "box2i") header.data_window = read_window(value);
    if (name == "displayWindow" && type == "box2i") read_window(value);
    HeaderCursor content = value;
    if (name == "compression" && type == "compression") header.block_rows = rows_of_block(content.byte());
    if (name == "tiles" && type == "tiledesc") {
      const int64_t width = content.word(), height = content.word();
      header.tile = PixelWindow{width, height};
    }
  }
  return header;
}

/// Entries of the table of where pixels are, 8 bytes each. Levels of tiles come besides.
uint64_t blocks_of(const HeaderValues& header, bool tiled, const HeaderCursor& file) {
  const PixelWindow& window = *header.data_window;
  if (!tiled) return uint64_t((window.height + *header.block_rows - 1) / *header.block_rows);
  if (!header.tile || header.tile->width < 1 || header.tile->height < 1) file.fail("its tiles have no size");
  return uint64_t((window.width + header.tile->width - 1) / header.tile->width) *
         uint64_t((window.height + header.tile->height - 1) / header.tile->height);
}

/// What a header says, after it is known to be whole. `entries`: of the tables behind the headers so far.
ExrLayout checked_layout(const std::string& where, const HeaderValues& header, bool tiled, const HeaderCursor& file,
                         uint64_t& entries) {
  if (!header.data_window || !header.pixel_bytes || *header.pixel_bytes == 0 || !header.block_rows)
    file.fail("its header names no channels, window or compression");
  if (*header.block_rows == 0) file.fail("its compression is not known", "store it with ZIP");
  const PixelWindow& window = *header.data_window;
  if (window.width > kMaxSide || window.height > kMaxSide)
    throw Error(ErrorKind::limit, where, "it is over 1048576 pixels a side", "give a part of it");
  entries += blocks_of(header, tiled, file);
  return {int(window.width), int(window.height), *header.pixel_bytes};
}

std::vector<ExrLayout> layouts_of(const std::string& where, std::span<const uint8_t> bytes, size_t most_parts) {
  HeaderCursor file(where, bytes, 0, bytes.size());
  constexpr uint32_t kMagic = 0x01312f76;
  if (file.word() != kMagic) file.fail("it is no EXR");
  const uint32_t version = file.word();
  if ((version & 0xff) != 2 || (version & ~(0xffu | kTiledFlag | kLongNamesFlag | kDeepFlag | kPartsFlag)) != 0)
    file.fail("its version of EXR is not known", "store version 2");
  const bool in_parts = (version & kPartsFlag) != 0;
  if (in_parts && most_parts == 1) file.fail("it has several parts", "store one, with all channels");
  if ((version & kDeepFlag) != 0) file.fail("it is a deep image", "store one sample a pixel");
  std::vector<ExrLayout> layouts;
  uint64_t entries = 0;
  do {
    if (layouts.size() == most_parts) file.fail("it has over 64 parts", "store fewer");
    const HeaderValues header = read_attributes(file);
    layouts.push_back(
        checked_layout(where, header, header.tile.has_value() || (version & kTiledFlag) != 0, file, entries));
  } while (in_parts && !file.take_zero());
  if (entries > file.left() / 8) file.fail("the EXR ends before its pixels do");
  return layouts;
}

}  // namespace

ExrLayout exr_layout(const std::string& where, std::span<const uint8_t> bytes) {
  return layouts_of(where, bytes, 1).front();
}

std::vector<ExrLayout> exr_part_layouts(const std::string& where, std::span<const uint8_t> bytes) {
  return layouts_of(where, bytes, kMostParts);
}

}  // namespace trueshade
