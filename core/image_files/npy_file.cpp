// Robert Kern, "NEP 1: A simple file format for NumPy arrays", 2007, with the versions 2.0 and 3.0 of numpy.lib.format.
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/half.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"

namespace trueshade {
namespace {

constexpr std::string_view kNpyMagic("\x93NUMPY", 6);
constexpr size_t kMostNpyHeader = 4096, kMostNpyChannels = 64;

/// The text of a header: a Python dictionary of three keys, read strictly.
class NpyHeaderText {
 public:
  NpyHeaderText(const std::string& where, std::string_view text) : where_(where), rest_(text) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorKind::bad_input, where_, "its .npy header " + reason, "write it by numpy.save");
  }
  void skip_space() {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\n' || rest_[0] == '\t')) rest_.remove_prefix(1);
  }
  bool take(char c) {
    skip_space();
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(std::string("lacks a '") + c + "'");
  }
  std::string_view quoted() {
    skip_space();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) fail("has no text where one belongs");
    const size_t end = rest_.find(rest_[0], 1);
    if (end == std::string_view::npos) fail("has a text without an end");
    const std::string_view text = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return text;
  }
  bool truth() {
    skip_space();
    for (const std::string_view word : {"True", "False"})
      if (rest_.starts_with(word)) {
        rest_.remove_prefix(word.size());
        return word == "True";
      }
    fail("has no True or False where one belongs");
  }
  uint64_t number() {
    skip_space();
    uint64_t value = 0;
    size_t digits = 0;
    while (digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9' && digits < 12)
      value = 10 * value + uint64_t(rest_[digits++] - '0');
    if (digits == 0 || digits == 12) fail("has no size where one belongs");
    rest_.remove_prefix(digits);
    return value;
  }
  bool at_end() {
    skip_space();
    return rest_.empty();
  }

 private:
  const std::string& where_;
  std::string_view rest_;
};

/// How the array lies in the file.
struct NpyLayout {
  char kind = 0;  ///< f, u, i, b
  size_t bytes = 0;
  bool big_endian = false, fortran_order = false;
  std::vector<uint64_t> shape;
  size_t data = 0;  ///< where it begins
};

void read_element_type(NpyHeaderText& text, std::string_view descr, NpyLayout& layout) {
  if (descr.size() == 3 && std::string_view("<>|=").find(descr[0]) != std::string_view::npos) {
    layout.big_endian = descr[0] == '>';
    layout.kind = descr[1];
    layout.bytes = size_t(descr[2] - '0');
    const bool whole = layout.kind == 'u' || layout.kind == 'i';
    if (layout.kind == 'b' && layout.bytes == 1) return;
    if (layout.kind == 'f' && (layout.bytes == 2 || layout.bytes == 4 || layout.bytes == 8)) return;
    if (whole && (layout.bytes == 1 || layout.bytes == 2 || layout.bytes == 4 || layout.bytes == 8)) return;
  }
  text.fail("names the type '" + std::string(descr.substr(0, 32)) + "', not a float, an integer or a bool");
}

void read_shape(NpyHeaderText& text, NpyLayout& layout) {
  text.expect('(');
  while (!text.take(')')) {
    if (layout.shape.size() == 4) text.fail("has over 4 sizes");
    layout.shape.push_back(text.number());
    if (!text.take(',')) {
      text.expect(')');
      break;
    }
  }
}

/// `text_at` and `length`: of the dictionary.
NpyLayout npy_layout(const std::string& where, std::span<const uint8_t> bytes) {
  const auto fail = [&](const std::string& reason) -> Error {
    return {ErrorKind::bad_input, where, reason, "write it by numpy.save"};
  };
  if (bytes.size() < 10) throw fail("the .npy ends inside its header");
  const int version = bytes[6];
  if (version < 1 || version > 3 || bytes[7] != 0) throw fail("its version of .npy is not 1.0, 2.0 or 3.0");
  const size_t text_at = version == 1 ? 10 : 12;
  if (bytes.size() < text_at) throw fail("the .npy ends inside its header");
  size_t length = bytes[8] | size_t(bytes[9]) << 8;
  if (version > 1) length |= size_t(bytes[10]) << 16 | size_t(bytes[11]) << 24;
  if (length > kMostNpyHeader || length > bytes.size() - text_at) throw fail("the .npy ends inside its header");
  NpyHeaderText text(where, {reinterpret_cast<const char*>(bytes.data()) + text_at, length});
  NpyLayout layout;
  layout.data = text_at + length;
  bool has_type = false, has_order = false, has_shape = false;
  text.expect('{');
  while (!text.take('}')) {
    const std::string_view key = text.quoted();
    text.expect(':');
    bool& seen = key == "descr" ? has_type : key == "fortran_order" ? has_order : has_shape;
    if (seen || (key != "descr" && key != "fortran_order" && key != "shape")) text.fail("has a key too many");
    seen = true;
    if (key == "descr") read_element_type(text, text.quoted(), layout);
    if (key == "fortran_order") layout.fortran_order = text.truth();
    if (key == "shape") read_shape(text, layout);
    if (!text.take(',')) {
      text.expect('}');
      break;
    }
  }
  if (!has_type || !has_order || !has_shape) text.fail("lacks descr, fortran_order or shape");
  if (!text.at_end()) text.fail("goes on behind its dictionary");
  return layout;
}

uint64_t npy_word(const uint8_t* at, const NpyLayout& layout) {
  uint64_t word = 0;
  for (size_t k = 0; k < layout.bytes; ++k)
    word |= uint64_t(at[layout.big_endian ? layout.bytes - 1 - k : k]) << (8 * k);
  return word;
}

/// The element as Channel::words holds it; nothing for an integer that is negative or over 32 bits.
std::optional<uint32_t> npy_element(uint64_t word, const NpyLayout& layout, bool& is_rounded) {
  if (layout.kind == 'f') {
    if (layout.bytes == 2) return std::bit_cast<uint32_t>(float_from_half(uint16_t(word)));
    if (layout.bytes == 4) return uint32_t(word);
    const double value = std::bit_cast<double>(word);
    const double most = 3.4028234663852886e38;  // beyond it a conversion to float has no meaning
    const float near = value > most ? INFINITY : value < -most ? -INFINITY : float(value);
    is_rounded = is_rounded || (std::isfinite(value) && double(near) != value);
    return std::bit_cast<uint32_t>(near);
  }
  const bool negative = layout.kind == 'i' && (word >> (8 * layout.bytes - 1) & 1) != 0;
  return negative || word > 0xffffffffu ? std::nullopt : std::optional(uint32_t(word));
}

}  // namespace

std::string channel_name(size_t index, size_t count) {
  return count <= 4 ? std::string(1, "RGBA"[index]) : std::to_string(index);
}

ChannelFile npy_channels(const std::string& where, std::span<const uint8_t> bytes) {
  const NpyLayout layout = npy_layout(where, bytes);
  if (layout.shape.size() != 2 && layout.shape.size() != 3)
    throw bad_image(where, "its array has " + std::to_string(layout.shape.size()) + " axes",
                    "save an array of shape (height, width) or (height, width, channels)");
  const uint64_t height = layout.shape[0], width = layout.shape[1],
                 count = layout.shape.size() == 3 ? layout.shape[2] : 1;
  if (count < 1 || count > kMostNpyChannels)
    throw bad_image(where, "its array has " + std::to_string(count) + " channels",
                    "the last axis is that of channels, 1 to 64");
  check_size(where, int(std::min<uint64_t>(width, 1 << 30)), int(std::min<uint64_t>(height, 1 << 30)));
  const uint64_t pixels = width * height;
  if (bytes.size() - layout.data != pixels * count * layout.bytes)
    throw bad_image(where,
                    "its array of " + std::to_string(pixels * count * layout.bytes) + " bytes has " +
                        std::to_string(bytes.size() - layout.data),
                    "write it by numpy.save");
  require_memory(4 * pixels * count, where, "the array");
  ChannelFile file{where, int(width), int(height), {}};
  const uint8_t* const data = bytes.data() + layout.data;
  for (uint64_t c = 0; c < count; ++c) {
    Channel channel;
    channel.name = channel_name(c, count);
    channel.kind = layout.kind == 'f' ? ChannelKind::floating
                   : layout.bytes > 2 ? ChannelKind::integer
                                      : ChannelKind::unorm;
    if (layout.kind == 'i' || layout.kind == 'b') channel.kind = ChannelKind::integer;
    channel.bits = std::min(int(8 * layout.bytes), layout.kind == 'f' ? 64 : 32);
    channel.words.resize(pixels);
    for (uint64_t y = 0, i = 0; y < height; ++y)
      for (uint64_t x = 0; x < width; ++x, ++i) {
        const uint64_t at = layout.fortran_order ? y + height * (x + width * c) : i * count + c;
        const auto word = npy_element(npy_word(data + at * layout.bytes, layout), layout, channel.is_rounded);
        if (!word)
          throw bad_image(
              where, "the integer at " + std::to_string(x) + ',' + std::to_string(y) + " is negative or over 32 bits",
              "save unsigned ones");
        channel.words[i] = *word;
      }
    file.channels.push_back(std::move(channel));
  }
  return file;
}

}  // namespace trueshade
