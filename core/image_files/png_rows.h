#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// What an IHDR says of rows (PNG, section 11.2.2), checked by png_header().
struct PngLayout {
  int width = 0, height = 0;
  uint8_t color_type = 0, bits = 8;  ///< bits of a channel
  bool interlaced = false;

  size_t channels() const;  ///< of a texel in the file; of a palette the index
  size_t row_bytes(int columns) const { return (size_t(columns) * channels() * bits + 7) / 8; }
  size_t texel_bytes() const { return channels() * bits < 8 ? 1 : channels() * bits / 8; }  ///< as filters count them
};

/// Every `dx`-th column and `dy`-th row from (x0, y0) on: a pass of Adam7, or the whole picture (section 8.2).
struct PngPass {
  int x0, y0, dx, dy;
  int columns(const PngLayout& layout) const { return layout.width > x0 ? (layout.width - x0 + dx - 1) / dx : 0; }
  int rows(const PngLayout& layout) const { return layout.height > y0 ? (layout.height - y0 + dy - 1) / dy : 0; }
};
std::span<const PngPass> png_passes(const PngLayout& layout);

/// Undoes a row's filter in place (section 9.2). `above`: the row before it in its pass, undone; zeros before the
/// first. False for a filter that PNG does not know.
bool undo_png_filter(uint8_t filter, std::span<uint8_t> row, std::span<const uint8_t> above, size_t texel_bytes);

/// What a PNG's colours are beside their codes.
struct PngColors {
  uint8_t palette[256][4] = {};
  size_t palette_size = 0;
  std::optional<uint16_t> key[3] = {};  ///< of a tRNS of grey or RGB: texels of these codes have alpha 0
};

/// Texels of a row as RGBA, of 16 bits where the file has 16 and of 8 otherwise, little-endian, one every `step` texels
/// from `out` on. Grey is spread over R, G and B; fewer than 8 bits are widened, RN(k * 255 / (2^bits - 1)). False
/// where an index is beyond the palette.
bool png_row_as_rgba(const PngLayout& layout, const PngColors& colors, std::span<const uint8_t> row, int columns,
                     size_t step, uint8_t* out);

}  // namespace trueshade
