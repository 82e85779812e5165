// Greg Ward, "Real Pixels", Graphics Gems II, 1991; "Radiance File Formats" (filefmts), section "Picture File Format".
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/error.h"
#include "core/expansion.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"

namespace trueshade {
namespace {

constexpr size_t kMostHdrHeader = size_t(1) << 16;

/// The bytes of a Radiance picture, read from the front.
class HdrFile {
 public:
  HdrFile(const std::string& where, std::span<const uint8_t> bytes) : where_(where), bytes_(bytes) {}

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy = "write the file again") const {
    throw Error(ErrorKind::bad_input, where_ + ": byte " + std::to_string(at_), reason, remedy);
  }
  size_t left() const { return bytes_.size() - at_; }
  uint8_t byte() {
    if (at_ == bytes_.size()) fail("the picture ends before its pixels do");
    return bytes_[at_++];
  }
  std::array<uint8_t, 4> four() {
    std::array<uint8_t, 4> codes;
    for (uint8_t& code : codes) code = byte();
    return codes;
  }
  void step_back(size_t bytes) { at_ -= bytes; }

  /// A line of the header, without its end.
  std::string_view line() {
    const auto begin = bytes_.begin() + std::ptrdiff_t(at_), end = bytes_.end();
    const auto stop = std::find(begin, end, uint8_t('\n'));
    if (stop == end || size_t(stop - bytes_.begin()) > kMostHdrHeader) fail("its header has no end");
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + at_, size_t(stop - begin));
    at_ += text.size() + 1;
    return text;
  }

 private:
  const std::string& where_;
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
};

struct HdrSize {
  int width, height;
};

/// `-Y HEIGHT +X WIDTH`: rows from the top, pixels from the left.
HdrSize hdr_size(const HdrFile& file, std::string_view line) {
  const auto number = [&line](std::string_view sign) -> int {
    if (!line.starts_with(sign)) return -1;
    line.remove_prefix(sign.size());
    int value = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc() || value < 1) return -1;
    line.remove_prefix(size_t(end - line.data()));
    return value;
  };
  const int height = number("-Y "), width = number(" +X ");
  if (height < 0 || width < 0 || !line.empty())
    file.fail("its rows do not run from the top and from the left, or it has no size", "save it as -Y HEIGHT +X WIDTH");
  return {width, height};
}

HdrSize hdr_header(HdrFile& file) {
  bool has_format = false;
  if (!file.line().starts_with("#?")) file.fail("it is no Radiance picture");
  for (std::string_view line = file.line(); !line.empty(); line = file.line()) {
    if (!line.starts_with("FORMAT=")) continue;
    if (line.substr(7) != "32-bit_rle_rgbe") file.fail("its format is not 32-bit_rle_rgbe", "save it as RGBE");
    has_format = true;
  }
  if (!has_format) file.fail("its header names no FORMAT");
  return hdr_size(file, file.line());
}

using HdrRow = std::vector<std::array<uint8_t, 4>>;

/// A row whose components stand apart, each packed: a count above 128 repeats one byte, one up to 128 copies as many.
void read_packed_row(HdrFile& file, HdrRow& row) {
  for (size_t component = 0; component < 4; ++component)
    for (size_t x = 0; x < row.size();) {
      const uint8_t count = file.byte();
      const size_t length = count > 128 ? count - 128u : count;
      if (length == 0 || length > row.size() - x) file.fail("a row has more pixels than the picture");
      uint8_t code = count > 128 ? file.byte() : uint8_t(0);
      for (size_t end = x + length; x < end; ++x) {
        if (count <= 128) code = file.byte();
        row[x][component] = code;
      }
    }
}

/// A row of whole pixels. 1, 1, 1, N stands for the pixel before it, N times; after each other, N counts 256 as much.
void read_plain_row(HdrFile& file, HdrRow& row) {
  int shift = 0;
  for (size_t x = 0; x < row.size();) {
    const std::array<uint8_t, 4> codes = file.four();
    if (codes[0] != 1 || codes[1] != 1 || codes[2] != 1) {
      row[x++] = codes;
      shift = 0;
      continue;
    }
    if (x == 0 || shift > 24) file.fail("it repeats a pixel that is not there");
    const uint64_t length = uint64_t(codes[3]) << shift;
    if (length > row.size() - x) file.fail("a row has more pixels than the picture");
    for (uint64_t i = 0; i < length; ++i, ++x) row[x] = row[x - 1];
    shift += 8;
  }
}

void read_row(HdrFile& file, HdrRow& row) {
  constexpr size_t kLeastPacked = 8, kMostPacked = 32767;
  if (row.size() < kLeastPacked || row.size() > kMostPacked) return read_plain_row(file, row);
  const std::array<uint8_t, 4> mark = file.four();
  if (mark[0] != 2 || mark[1] != 2 || (mark[2] & 0x80) != 0) {
    file.step_back(4);
    return read_plain_row(file, row);
  }
  if (size_t(mark[2]) << 8 != row.size() - mark[3]) file.fail("a row has another width than the picture");
  read_packed_row(file, row);
}

}  // namespace

ChannelFile hdr_channels(const std::string& where, std::span<const uint8_t> bytes, uint64_t most_expansion) {
  HdrFile file(where, bytes);
  const HdrSize size = hdr_header(file);
  check_size(where, size.width, size.height);
  const uint64_t pixels = uint64_t(size.width) * uint64_t(size.height);
  if (is_expanded(12 * pixels, bytes.size(), most_expansion))
    throw Error(ErrorKind::limit, where,
                std::to_string(bytes.size()) + " bytes hold a picture of " + std::to_string(12 * pixels) +
                    ", over --max-expansion " + std::to_string(most_expansion),
                "a smaller picture, or a higher --max-expansion");
  require_memory(12 * pixels, where, "the picture");
  ChannelFile result{where, size.width, size.height, {}};
  for (size_t c = 0; c < 3; ++c) {
    Channel channel;
    channel.name = channel_name(c, 3);
    channel.words.reserve(pixels);
    result.channels.push_back(std::move(channel));
  }
  HdrRow row(size_t(size.width));
  for (int y = 0; y < size.height; ++y) {
    read_row(file, row);
    for (const std::array<uint8_t, 4>& codes : row)
      for (size_t c = 0; c < 3; ++c) {
        const float value = codes[3] == 0 ? 0.0f : float(std::ldexp(double(codes[c]), int(codes[3]) - 136));
        result.channels[c].words.push_back(std::bit_cast<uint32_t>(value));
      }
  }
  return result;
}

}  // namespace trueshade
