#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/format.h"

namespace trueshade {

/// Stored texels of one plane. Rows run from the top of the picture down, without padding; channels R, G, B, A;
/// multi-byte channels and packed words little-endian. These bytes are what `--hash` hashes.
struct Image {
  int width = 0, height = 0;  ///< pixels
  Format format = Format::rgba8;
  std::vector<uint8_t> texels;

  Image() = default;
  Image(int w, int h, Format f);  ///< all bytes zero

  size_t row_bytes() const { return size_t(width) * size_t(info(format).bytes_per_texel()); }
  uint8_t* texel(int x, int y) { return texels.data() + offset(x, y); }  ///< y counts from the top
  const uint8_t* texel(int x, int y) const { return texels.data() + offset(x, y); }

  /// The stored bits of one channel, as the lowest bits of the word. y counts from the top.
  uint32_t code(int x, int y, int channel) const;
  uint32_t code(const FormatInfo& layout, int x, int y, int channel) const;  ///< layout: info(format), for many texels
  /// Replaces the stored bits of one channel. The bits above the channel's are 0.
  void set_code(int x, int y, int channel, uint32_t bits);
  void set_code(const FormatInfo& layout, int x, int y, int channel, uint32_t bits);

  /// Value of one channel, as a float: unorm RN(code / largest), sRGB decoded to linear, floats of any size as they
  /// are; integers converted. y from the top.
  double value(int x, int y, int channel) const;

 private:
  size_t offset(int x, int y) const {
    return size_t(y) * row_bytes() + size_t(x) * size_t(info(format).bytes_per_texel());
  }
};

/// A named plane beside the colour target, as `--aov` names it.
struct NamedImage {
  std::string name;
  Image image;
};

/// SHA-256 of the stored bytes, 64 hex digits; every NaN counts as the quiet NaN 7FC00000 (half: 7E00; 11 and
/// 10 bits: 7E0, 3F0).
std::string image_hash(const Image& image);

}  // namespace trueshade
