#include "view/display_codes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/fp_env.h"
#include "core/image_files/png_codes.h"
#include "core/image_rows.h"
#include "core/srgb_codes.h"
#include "core/threads/parallel_for.h"

namespace trueshade::viewer {
namespace {

constexpr int kMostTableBits = 16;

uint8_t code_of(float value, bool is_linear, const DisplayTransform& display) {
  if (display != DisplayTransform()) value = float(shown_light(double(value), display));
  if (is_linear) return srgb8_code_of(value);
  return uint8_t(std::nearbyint(255.0f * (value > 0.0f ? std::min(value, 1.0f) : 0.0f)));  // NaN is 0
}

uint32_t word_of(const uint8_t rgb[3]) { return uint32_t(rgb[0]) << 16 | uint32_t(rgb[1]) << 8 | rgb[2]; }

/// Of four bytes R, G, B, A on a little-endian machine.
uint32_t word_of_bytes(uint32_t bits) { return (bits & 0xffu) << 16 | (bits & 0xff00u) | (bits >> 16 & 0xffu); }

template <size_t n>
void swap_bytes(const uint8_t* texels, uint32_t* out) {
  uint32_t bits[n];
  std::memcpy(bits, texels, sizeof bits);
  for (uint32_t& word : bits) word = word_of_bytes(word);
  std::memcpy(out, bits, sizeof bits);
}

bool is_tabulated(const FormatInfo& layout) {
  return std::all_of(layout.bits.begin(), layout.bits.begin() + 3, [](int bits) { return bits <= kMostTableBits; });
}

/// Whether R, G and B have as many bits each; r11g11b10f has not.
bool has_one_table(const FormatInfo& layout) {
  return is_tabulated(layout) && layout.bits[0] == layout.bits[1] && layout.bits[0] == layout.bits[2];
}

bool holds_linear_light(const FormatInfo& layout, PictureValues values) {
  return layout.number_class != NumberClass::unorm && values == PictureValues::of_target;
}

}  // namespace

void DisplayCodes::make_table(Format format, PictureValues values, const DisplayTransform& display) {
  if (!of_code_.empty() && format == format_ && values == values_ && display == display_) return;
  const FpScope fp;
  const FormatInfo layout = info(format);
  format_ = format, values_ = values, display_ = display;
  of_code_.resize(size_t(1) << layout.bits[0]);
  const uint32_t largest = uint32_t(of_code_.size() - 1);
  for (uint32_t code = 0; code < of_code_.size(); ++code) {
    const bool linear = holds_linear_light(layout, values) || (layout.srgb && display != DisplayTransform());
    if (layout.number_class == NumberClass::unorm && display == DisplayTransform())
      of_code_[code] = uint8_t((code * 255 + largest / 2) / largest);
    else
      of_code_[code] = code_of(float(value_of_code(layout, 0, code)), linear, display);
  }
}

void DisplayCodes::convert(const Image& image, PictureValues values, const DisplayTransform& asked,
                           std::vector<uint32_t>& out) {
  const FormatInfo layout = info(image.format);
  const DisplayTransform display = values == PictureValues::of_target ? asked : DisplayTransform();
  const bool by_table = has_one_table(layout), linear = holds_linear_light(layout, values);
  if (holds_display_codes(image) && display == DisplayTransform()) return out.clear();
  if (by_table) make_table(image.format, values, display);
  out.resize(size_t(image.width) * size_t(image.height));
  const int bands = (image.height + kRowsOfBand - 1) / kRowsOfBand;
  parallel_for(bands, 0, [&](int band) {
    const FpScope fp;
    std::vector<float> row(by_table ? 0 : 3 * size_t(image.width));
    for (int y = band * kRowsOfBand; y < std::min(image.height, (band + 1) * kRowsOfBand); ++y) {
      uint32_t* const words = out.data() + size_t(y) * size_t(image.width);
      if (!by_table) read_row(image, y, 3, row.data());
      for (int x = 0; x < image.width; ++x) {
        uint8_t rgb[3];
        for (int c = 0; c < 3; ++c)
          rgb[c] = by_table ? of_code_[image.code(layout, x, y, c)]
                            : code_of(row[3 * size_t(x) + size_t(c)], linear, display);
        words[x] = word_of(rgb);
      }
    }
  });
}

bool holds_display_codes(const Image& image) {
  const FormatInfo layout = info(image.format);
  return layout.bytes_per_channel == 1 && layout.channels == 4;
}

void read_words(const Image& image, const std::vector<uint32_t>& words, int x, int y, std::span<uint32_t> out) {
  if (!words.empty()) {
    std::memcpy(out.data(), words.data() + size_t(y) * size_t(image.width) + size_t(x), out.size_bytes());
    return;
  }
  constexpr size_t kAtOnce = 16;  // a fixed number: compilers make vectors of it
  const uint8_t* const texels = image.texel(x, y);
  size_t i = 0;
  for (; i + kAtOnce <= out.size(); i += kAtOnce) swap_bytes<kAtOnce>(texels + 4 * i, out.data() + i);
  for (; i < out.size(); ++i) swap_bytes<1>(texels + 4 * i, out.data() + i);
}

}  // namespace trueshade::viewer
