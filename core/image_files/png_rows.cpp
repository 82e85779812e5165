// W3C, Portable Network Graphics (PNG) Specification (Second Edition), sections 7.2, 8.2, 9.2 and 13.12.
#include "core/image_files/png_rows.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace trueshade {
namespace {

enum TexelKind : uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

constexpr PngPass kWhole[] = {{0, 0, 1, 1}};
constexpr PngPass kAdam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                              {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};

int paeth(int left, int above, int corner) {
  const int estimate = left + above - corner;
  const int a = std::abs(estimate - left), b = std::abs(estimate - above), c = std::abs(estimate - corner);
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

/// Adds what `guess` makes of the bytes to the left, above, and above the left one.
template <typename Guess>
void add_guesses(std::span<uint8_t> row, std::span<const uint8_t> above, size_t texel_bytes, Guess guess) {
  const size_t first = std::min(texel_bytes, row.size());
  for (size_t i = 0; i < first; ++i) row[i] = uint8_t(row[i] + guess(0, above[i], 0));
  for (size_t i = first; i < row.size(); ++i)
    row[i] = uint8_t(row[i] + guess(row[i - texel_bytes], above[i], above[i - texel_bytes]));
}

/// The codes of a row one after another.
class Codes {
 public:
  Codes(std::span<const uint8_t> row, int bits) : row_(row.data()), bits_(bits) {}
  uint16_t next() {
    if (bits_ == 8) return row_[at_++];
    if (bits_ == 16) {
      at_ += 2;
      return uint16_t(row_[at_ - 2] << 8 | row_[at_ - 1]);
    }
    const auto code = uint16_t(row_[at_] >> (8 - bits_ - used_) & ((1 << bits_) - 1));  // leftmost in the high bits
    used_ += bits_;
    if (used_ == 8) ++at_, used_ = 0;
    return code;
  }

 private:
  const uint8_t* row_;
  int bits_;
  size_t at_ = 0;
  int used_ = 0;  ///< bits of the byte at at_
};

bool is_key(const PngColors& colors, const uint16_t* codes, size_t count) {
  for (size_t c = 0; c < count; ++c)
    if (colors.key[c] != codes[c]) return false;
  return true;
}

bool palette_row_as_rgba(const PngLayout& layout, const PngColors& colors, std::span<const uint8_t> row, int columns,
                         size_t step, uint8_t* out) {
  Codes codes(row, layout.bits);
  for (int x = 0; x < columns; ++x, out += 4 * step) {
    const uint16_t index = codes.next();
    if (index >= colors.palette_size) return false;
    std::copy_n(colors.palette[index], 4, out);
  }
  return true;
}

}  // namespace

size_t PngLayout::channels() const {
  return color_type == kRgba ? 4 : color_type == kRgb ? 3 : color_type == kGreyAlpha ? 2 : 1;
}

std::span<const PngPass> png_passes(const PngLayout& layout) {
  return layout.interlaced ? std::span<const PngPass>(kAdam7) : kWhole;
}

bool undo_png_filter(uint8_t filter, std::span<uint8_t> row, std::span<const uint8_t> above, size_t texel_bytes) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      add_guesses(row, above, texel_bytes, [](int left, int, int) { return left; });
      return true;
    case 2:
      add_guesses(row, above, texel_bytes, [](int, int up, int) { return up; });
      return true;
    case 3:
      add_guesses(row, above, texel_bytes, [](int left, int up, int) { return (left + up) / 2; });
      return true;
    case 4:
      add_guesses(row, above, texel_bytes, paeth);
      return true;
    default:
      return false;
  }
}

bool png_row_as_rgba(const PngLayout& layout, const PngColors& colors, std::span<const uint8_t> row, int columns,
                     size_t step, uint8_t* out) {
  if (layout.color_type == kPalette) return palette_row_as_rgba(layout, colors, row, columns, step, out);
  const bool wide = layout.bits == 16, alpha = layout.color_type == kRgba || layout.color_type == kGreyAlpha;
  const size_t channels = layout.channels(), shown = channels - (alpha ? 1 : 0);
  const unsigned largest = (1u << layout.bits) - 1, scale = wide ? 1 : 255 / largest;  // 1, 3, 15 and 255 divide 255
  Codes codes(row, layout.bits);
  for (int x = 0; x < columns; ++x, out += 4 * step * (wide ? 2 : 1)) {
    uint16_t texel[4] = {};
    for (size_t c = 0; c < channels; ++c) texel[c] = codes.next();
    const uint16_t opacity = alpha                          ? texel[channels - 1]
                             : is_key(colors, texel, shown) ? uint16_t(0)
                                                            : uint16_t(largest);
    const uint16_t rgba[4] = {texel[0], texel[shown == 3 ? 1 : 0], texel[shown == 3 ? 2 : 0], opacity};
    for (size_t c = 0; c < 4; ++c) {
      const unsigned code = rgba[c] * scale;
      if (wide)
        out[2 * c] = uint8_t(code), out[2 * c + 1] = uint8_t(code >> 8);
      else
        out[c] = uint8_t(code);
    }
  }
  return true;
}

}  // namespace trueshade
