#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// What the numbers of a channel are.
enum class ChannelKind : uint8_t {
  floating,  ///< floats of 10, 11, 16, 32 or 64 bits
  unorm,     ///< codes k that stand for k / (2^bits - 1), or for themselves where numbers are asked for
  srgb,      ///< codes of 8 bits that stand for sRGB values
  snorm,     ///< codes k that stand for max(k / (2^(bits - 1) - 1), -1)
  integer,   ///< unsigned integers
};

/// One channel of a file, with the precision that the file gives. Rows run from the file's first to its last, which is
/// from the top of a picture down.
struct Channel {
  std::string part;  ///< of a file of several parts, the part's name
  std::string name;  ///< R, G, B, A where the file has no names and at most four channels, else 0, 1, 2, ...
  ChannelKind kind = ChannelKind::floating;
  int bits = 32;                ///< of a number as the file stores it
  bool is_rounded = false;      ///< floats of 64 bits, some of which are no float32: those are rounded to nearest
  std::vector<uint32_t> words;  ///< bits of a float32; codes; of snorm in two's complement of 32 bits

  bool is_code() const { return kind == ChannelKind::unorm || kind == ChannelKind::srgb; }
  uint32_t largest_code() const {
    return kind == ChannelKind::snorm ? (1u << (bits - 1)) - 1 : bits == 32 ? ~0u : (1u << bits) - 1;
  }
  /// What the number at `pixel` stands for; sRGB codes as unorm.
  double value(size_t pixel) const {
    const uint32_t word = words[pixel];
    if (kind == ChannelKind::floating) return double(std::bit_cast<float>(word));
    if (kind == ChannelKind::integer) return double(word);
    if (kind != ChannelKind::snorm) return double(word) / largest_code();
    const double signed_value = double(int32_t(word)) / largest_code();
    return signed_value < -1.0 ? -1.0 : signed_value;
  }
};

/// All channels of a file, which are of one size.
struct ChannelFile {
  std::string path;
  int width = 0, height = 0;  ///< pixels
  std::vector<Channel> channels;
  /// Of an EXR whose data window is not its display window: the size of that, and where in it the pixels begin.
  int frame_width = 0, frame_height = 0, left = 0, top = 0;

  bool is_window() const { return frame_width != 0; }
};

/// Reads all channels of an EXR (of scan lines or tiles, of one part or several of one size), PNG, TIFF, DDS or .npy,
/// which the first bytes tell apart. Error(bad_input): none of these, torn, of a kind that is not read, parts of two
/// sizes. Error(limit): over 2^20 pixels a side or 2^31 in all, over --max-pixels, over `most_expansion`, over the
/// memory cap. Error(io): cannot be read.
ChannelFile read_channel_file(const std::string& path, uint64_t most_expansion);

// What read_channel_file() is made of. `where` stands in errors.

/// NumPy's format (NEP 1), versions 1 to 3: arrays of shape (height, width) or (height, width, channels), of floats of
/// 2, 4 or 8 bytes, of integers or of bools, in either order of bytes and of axes. Unsigned ones of 1 and 2 bytes are
/// unorm; bools are integers.
ChannelFile npy_channels(const std::string& where, std::span<const uint8_t> bytes);

/// DirectDraw Surface, its first level: one texture of two dimensions in a format without blocks.
ChannelFile dds_channels(const std::string& where, std::span<const uint8_t> bytes);

/// TIFF 6.0 of one page, in strips or tiles, uncompressed or by Deflate: 8 or 16 bits of unorm, floats of 2, 4 or 8
/// bytes, integers of 4.
ChannelFile tiff_channels(const std::string& where, std::span<const uint8_t> bytes);

/// Radiance HDR (RGBE): R, G and B as floats, m * 2^(e - 136) of a code m and the exponent e. EXPOSURE and COLORCORR of
/// its header are not applied.
ChannelFile hdr_channels(const std::string& where, std::span<const uint8_t> bytes, uint64_t most_expansion);

/// The parts of an EXR, by OpenImageIO. The lengths in its header have been checked (exr_layout.h).
std::vector<ChannelFile> exr_part_channels(const std::string& where, std::span<const uint8_t> bytes);

/// R, G, B, A for up to four channels, else 0, 1, 2, ...
std::string channel_name(size_t index, size_t count);

}  // namespace trueshade
