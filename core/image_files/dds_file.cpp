// Microsoft, "Programming Guide for DDS": DDS_HEADER, DDS_PIXELFORMAT, DDS_HEADER_DXT10; DXGI_FORMAT; D3DFORMAT.
#include <algorithm>
#include <array>
#include <iterator>

#include "core/error.h"
#include "core/half.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/size_limits.h"
#include "core/memory_cap.h"
#include "core/small_float.h"

namespace trueshade {
namespace {

/// A texel of `bytes` bytes: little-endian words of 4 bytes or less, and in which bits the channels lie.
struct DdsFormat {
  ChannelKind kind = ChannelKind::unorm;
  int bytes = 0, channels = 0;
  std::array<int, 4> first{}, bits{};  ///< of R, G, B, A, from the texel's lowest bit
};

/// Channels of equal width one after another.
constexpr DdsFormat dds_even(ChannelKind kind, int bits, int channels) {
  return {kind, bits * channels / 8, channels, {0, bits, 2 * bits, 3 * bits}, {bits, bits, bits, bits}};
}
constexpr DdsFormat dds_bgra(ChannelKind kind, int channels) {
  return {kind, 4, channels, {16, 8, 0, 24}, {8, 8, 8, 8}};
}
constexpr DdsFormat dds_packed(ChannelKind kind, std::array<int, 4> bits, int channels) {
  return {kind, 4, channels, {0, bits[0], bits[0] + bits[1], bits[0] + bits[1] + bits[2]}, bits};
}

struct NumberedFormat {
  uint32_t number;
  DdsFormat format;
};
constexpr auto kFloats = ChannelKind::floating;
constexpr auto kCodes = ChannelKind::unorm, kSignedCodes = ChannelKind::snorm;
constexpr auto kWholes = ChannelKind::integer;

// DXGI_FORMAT.
constexpr NumberedFormat kDxgi[] = {{2, dds_even(kFloats, 32, 4)},
                                    {3, dds_even(kWholes, 32, 4)},
                                    {6, dds_even(kFloats, 32, 3)},
                                    {7, dds_even(kWholes, 32, 3)},
                                    {10, dds_even(kFloats, 16, 4)},
                                    {11, dds_even(kCodes, 16, 4)},
                                    {12, dds_even(kWholes, 16, 4)},
                                    {13, dds_even(kSignedCodes, 16, 4)},
                                    {16, dds_even(kFloats, 32, 2)},
                                    {17, dds_even(kWholes, 32, 2)},
                                    {24, dds_packed(kCodes, {10, 10, 10, 2}, 4)},
                                    {26, dds_packed(kFloats, {11, 11, 10, 0}, 3)},
                                    {28, dds_even(kCodes, 8, 4)},
                                    {29, dds_even(ChannelKind::srgb, 8, 4)},
                                    {30, dds_even(kWholes, 8, 4)},
                                    {31, dds_even(kSignedCodes, 8, 4)},
                                    {34, dds_even(kFloats, 16, 2)},
                                    {35, dds_even(kCodes, 16, 2)},
                                    {36, dds_even(kWholes, 16, 2)},
                                    {37, dds_even(kSignedCodes, 16, 2)},
                                    {39, dds_even(kFloats, 32, 1)},
                                    {40, dds_even(kFloats, 32, 1)},  // typeless, D32_FLOAT
                                    {41, dds_even(kFloats, 32, 1)},
                                    {42, dds_even(kWholes, 32, 1)},
                                    {49, dds_even(kCodes, 8, 2)},
                                    {50, dds_even(kWholes, 8, 2)},
                                    {51, dds_even(kSignedCodes, 8, 2)},
                                    {54, dds_even(kFloats, 16, 1)},
                                    {55, dds_even(kCodes, 16, 1)},
                                    {56, dds_even(kCodes, 16, 1)},  // D16, R16
                                    {57, dds_even(kWholes, 16, 1)},
                                    {58, dds_even(kSignedCodes, 16, 1)},
                                    {61, dds_even(kCodes, 8, 1)},
                                    {62, dds_even(kWholes, 8, 1)},
                                    {63, dds_even(kSignedCodes, 8, 1)},
                                    {87, dds_bgra(kCodes, 4)},
                                    {88, dds_bgra(kCodes, 3)},
                                    {91, dds_bgra(ChannelKind::srgb, 4)},
                                    {93, dds_bgra(ChannelKind::srgb, 3)}};

// D3DFORMAT, in place of four letters.
constexpr NumberedFormat kDirect3d[] = {{36, dds_even(kCodes, 16, 4)},   {110, dds_even(kSignedCodes, 16, 4)},
                                        {111, dds_even(kFloats, 16, 1)}, {112, dds_even(kFloats, 16, 2)},
                                        {113, dds_even(kFloats, 16, 4)}, {114, dds_even(kFloats, 32, 1)},
                                        {115, dds_even(kFloats, 32, 2)}, {116, dds_even(kFloats, 32, 4)}};

constexpr uint32_t kDdsFourCc = 0x4, kDdsRgb = 0x40, kDdsLuminance = 0x20000, kDdsAlpha = 0x1;
constexpr uint32_t kDdsCube = 0x200, kDdsVolume = 0x200000, kDx10 = 0x30315844;
constexpr size_t kDdsHeader = 128, kDdsHeaderDx10 = 148;

struct DdsReader {
  const std::string& where;
  std::span<const uint8_t> bytes;

  [[noreturn]] void fail(const std::string& reason,
                         const std::string& remedy = "save it as EXR, or as DDS of a format without blocks") const {
    throw Error(ErrorKind::bad_input, where, reason, remedy);
  }
  uint32_t word(size_t at) const {
    return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
           uint32_t(bytes[at + 3]) << 24;
  }

  DdsFormat numbered(std::span<const NumberedFormat> formats, uint32_t number, const char* kind) const {
    const auto found =
        std::find_if(formats.begin(), formats.end(), [&](const NumberedFormat& f) { return f.number == number; });
    if (found == formats.end())
      fail(std::string("its ") + kind + ' ' + std::to_string(number) + " is compressed, or not one that is read");
    return found->format;
  }

  /// Channels by masks, each a run of at most 16 bits.
  DdsFormat masked(uint32_t flags) const {
    const uint32_t bits = word(88);
    if (bits != 8 && bits != 16 && bits != 32) fail("its texels have " + std::to_string(bits) + " bits");
    DdsFormat format{kCodes, int(bits / 8), 0, {}, {}};
    const bool alpha = (flags & kDdsAlpha) != 0;
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t mask = k == 3 && !alpha ? 0 : word(92 + 4 * k);
      if (mask == 0) continue;
      if ((flags & kDdsLuminance) != 0 && k > 0) fail("it has luminance with alpha");
      const int first = std::countr_zero(mask), count = std::popcount(mask);
      if (size_t(format.channels) != k || count > 16 || first + count > int(bits) ||
          (mask >> first) != (1u << count) - 1)
        fail("its masks are not of R, G, B, A in runs of bits");
      format.first[k] = first, format.bits[k] = count;
      ++format.channels;
    }
    if (format.channels == 0) fail("it has no channels");
    return format;
  }
};

uint32_t dds_word_of(const uint8_t* texel, const DdsFormat& format, size_t channel) {
  const int first = format.first[channel], bits = format.bits[channel];
  uint64_t window = 0;
  for (int k = 0; k < 5 && first / 8 + k < format.bytes; ++k) window |= uint64_t(texel[first / 8 + k]) << (8 * k);
  const auto code = uint32_t(window >> (first % 8) & ((uint64_t(1) << bits) - 1));
  if (format.kind == ChannelKind::snorm) {
    const int unused = 32 - bits;
    return uint32_t(int32_t(code << unused) >> unused);
  }
  if (format.kind != ChannelKind::floating || bits == 32) return code;
  return std::bit_cast<uint32_t>(bits == 16 ? float_from_half(uint16_t(code)) : float_from_unsigned(code, bits));
}

}  // namespace

ChannelFile dds_channels(const std::string& where, std::span<const uint8_t> bytes) {
  const DdsReader dds{where, bytes};
  if (bytes.size() < kDdsHeader || dds.word(4) != 124 || dds.word(76) != 32)
    dds.fail("the DDS ends inside its header, or has a wrong one", "write the file again");
  const uint32_t height = dds.word(12), width = dds.word(16), levels = std::max(dds.word(28), 1u), flags = dds.word(80);
  if ((dds.word(112) & (kDdsCube | kDdsVolume)) != 0) dds.fail("it is a cube or a volume", "save one face or slice");
  size_t data = kDdsHeader;
  DdsFormat format;
  if ((flags & kDdsFourCc) != 0 && dds.word(84) == kDx10) {
    if (bytes.size() < kDdsHeaderDx10) dds.fail("the DDS ends inside its header", "write the file again");
    if (dds.word(132) != 3 || (dds.word(136) & 0x4) != 0 || dds.word(140) > 1)
      dds.fail("it is no single texture of two dimensions", "save one face or slice");
    format = dds.numbered(kDxgi, dds.word(128), "DXGI_FORMAT");
    data = kDdsHeaderDx10;
  } else if ((flags & kDdsFourCc) != 0) {
    format = dds.numbered(kDirect3d, dds.word(84), "four letters or D3DFORMAT");
  } else if ((flags & (kDdsRgb | kDdsLuminance)) != 0) {
    format = dds.masked(flags);
  } else {
    dds.fail("its pixel format is not known");
  }
  check_size(where, int(std::min(width, 1u << 30)), int(std::min(height, 1u << 30)));
  if (levels > 15) dds.fail("it has over 15 levels", "write the file again");
  uint64_t expected = 0;
  for (uint32_t level = 0; level < levels; ++level)
    expected += uint64_t(std::max(width >> level, 1u)) * std::max(height >> level, 1u) * uint64_t(format.bytes);
  if (bytes.size() - data != expected)
    dds.fail("its " + std::to_string(levels) + " levels of " + std::to_string(expected) + " bytes have " +
                 std::to_string(bytes.size() - data),
             "write the file again");
  const size_t pixels = size_t(width) * height;
  require_memory(4 * pixels * uint64_t(format.channels), where, "the texture");
  ChannelFile file{where, int(width), int(height), {}};
  for (size_t c = 0; c < size_t(format.channels); ++c) {
    Channel channel;
    channel.name = channel_name(c, size_t(format.channels));
    channel.kind = format.kind == ChannelKind::srgb && c == 3 ? ChannelKind::unorm : format.kind;
    channel.bits = format.bits[c];
    channel.words.resize(pixels);
    for (size_t i = 0; i < pixels; ++i)
      channel.words[i] = dds_word_of(bytes.data() + data + i * size_t(format.bytes), format, c);
    file.channels.push_back(std::move(channel));
  }
  return file;
}

}  // namespace trueshade
