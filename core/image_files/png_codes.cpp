#include "core/image_files/png_codes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "core/image_rows.h"
#include "core/srgb_codes.h"

namespace trueshade {
namespace {

constexpr int kMostTableBits = 16;
constexpr double kFilmicScale = 0.6;

template <typename Word>
void read_words(const uint8_t* row, std::vector<uint32_t>& stored) {
  for (uint32_t& bits : stored) {
    Word word;
    std::memcpy(&word, row, sizeof word);
    bits = word;
    row += sizeof word;
  }
}

/// Bits of each channel of a row, pixel after pixel.
void read_stored(const Image& image, int y, std::vector<uint32_t>& stored) {
  const FormatInfo layout = info(image.format);
  const uint8_t* const row = image.texel(0, y);
  if (layout.bytes_per_channel == 1) return read_words<uint8_t>(row, stored);
  if (layout.bytes_per_channel == 2) return read_words<uint16_t>(row, stored);
  if (layout.bytes_per_channel == 4) return read_words<uint32_t>(row, stored);
  uint32_t* out = stored.data();
  for (int x = 0; x < image.width; ++x)
    for (int channel = 0; channel < layout.channels; ++channel) *out++ = image.code(x, y, channel);
}

}  // namespace

double srgb_from_linear(double linear) {
  if (linear <= 0.0031308) return linear * 12.92;
  double root = 1.0;
  for (double last = 2.0; root < last;) {  // falls until rounding stops it
    const double square = root * root, third = square * root, sixth = third * third;
    last = root;
    root = (11.0 * root + linear / (sixth * third * square)) / 12.0;
  }
  return 1.055 * (root * root * root * root * root) - 0.055;
}

double shown_light(double value, const DisplayTransform& display) {
  constexpr double kMost = 0x1p40;  // far above 1 on every curve, and its square is finite
  const double light = value > 0.0 ? std::min(value * display.scale, kMost) : 0.0;
  if (display.curve == ToneCurve::clip) return std::min(light, 1.0);
  const double y = kFilmicScale * light;
  return std::min(y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14), 1.0);
}

double light_behind(double shown, const DisplayTransform& display) {
  const double s = std::clamp(shown, 0.0, 1.0);
  if (display.curve == ToneCurve::clip) return s / display.scale;
  const double a = 2.51 - 2.43 * s, b = 0.03 - 0.59 * s;  // of a y^2 + b y = 0.14 s
  return (std::sqrt(b * b + 4.0 * a * (0.14 * s)) - b) / (2.0 * a) / (kFilmicScale * display.scale);
}

PngCodes::PngCodes(const Image& image, const ImageFileOptions& options)
    : image_(image),
      layout_(info(image.format)),
      channels_(layout_.channels),
      bits_(layout_.number_class == NumberClass::unorm && layout_.bits[0] > 8 ? 16 : 8),
      display_(options.values == PictureValues::display_codes ? DisplayTransform() : options.display),
      transfer_(transfer_of(layout_, options, display_ != DisplayTransform())),
      tag_(options.encoding == PngEncoding::raw && options.values == PictureValues::of_target ? PngTag::linear
                                                                                              : PngTag::srgb),
      as_stored_(transfer_ == Transfer::stored_code && layout_.bytes_per_channel == 1) {
  assert(layout_.number_class != NumberClass::integer);
  if (as_stored_ || display_.divides_by_alpha || layout_.bits[0] > kMostTableBits) return;
  for (int channel = 0; channel < channels_; ++channel) of_stored_.push_back(table_of(channel));
}

PngCodes::Transfer PngCodes::transfer_of(const FormatInfo& layout, const ImageFileOptions& options, bool transforms) {
  const Transfer transfer = transfer_without_transform(layout, options);
  if (!transforms || transfer != Transfer::stored_code) return transfer;
  return layout.srgb && options.encoding != PngEncoding::raw ? Transfer::srgb : Transfer::none;
}

PngCodes::Transfer PngCodes::transfer_without_transform(const FormatInfo& layout, const ImageFileOptions& options) {
  const bool fixed_point = layout.number_class == NumberClass::unorm;
  const bool are_codes = options.values == PictureValues::display_codes;
  if (are_codes || options.encoding == PngEncoding::by_values) {
    if (fixed_point) return Transfer::stored_code;
    return are_codes ? Transfer::none : Transfer::srgb;
  }
  if (options.encoding == PngEncoding::raw) return fixed_point && !layout.srgb ? Transfer::stored_code : Transfer::none;
  return layout.srgb ? Transfer::stored_code : Transfer::srgb;  // sRGB's own codes are what encoding would give
}

/// The nearest code, to even between two; NaN gives 0.
uint16_t PngCodes::code_of_value(double value, Transfer transfer) const {
  const double clamped = value > 0.0 ? std::min(value, 1.0) : 0.0;
  if (bits_ == 8 && transfer == Transfer::srgb) return srgb8_code_of(float(clamped));
  if (bits_ == 8) return uint16_t(std::nearbyint(255.0f * float(clamped)));
  const double coded = transfer == Transfer::srgb ? srgb_from_linear(clamped) : clamped;
  return uint16_t(std::nearbyint(65535.0 * coded));
}

uint16_t PngCodes::code_of_stored(uint32_t stored, int channel, double alpha_behind) const {
  const bool alpha = channel == 3, tabulated = layout_.bits[size_t(channel)] <= kMostTableBits;
  if (tabulated && layout_.number_class == NumberClass::unorm && (alpha || transfer_ == Transfer::stored_code)) {
    const uint32_t largest = layout_.largest_code(channel), most = bits_ == 8 ? 255 : 65535;
    return uint16_t((stored * most + largest / 2) / largest);  // the PNG specification's (12.4) linear equation
  }
  const double value = value_of_code(layout_, channel, stored) / (alpha ? 1.0 : alpha_behind);
  if (alpha) return code_of_value(double(float(value)), Transfer::none);
  return code_of_value(display_ == DisplayTransform() ? double(float(value)) : shown_light(value, display_), transfer_);
}

std::vector<uint16_t> PngCodes::table_of(int channel) const {
  std::vector<uint16_t> table(size_t(1) << layout_.bits[size_t(channel)]);
  for (uint32_t stored = 0; stored < table.size(); ++stored) table[stored] = code_of_stored(stored, channel);
  return table;
}

void PngCodes::row(int y, uint8_t* out) const {
  if (as_stored_) {
    std::memcpy(out, image_.texel(0, y), row_bytes());
    return;
  }
  std::vector<uint32_t> stored(size_t(image_.width) * size_t(channels_));
  read_stored(image_, y, stored);
  const bool tabulated = !of_stored_.empty(), wide = bits_ == 16;
  const bool divides = display_.divides_by_alpha && channels_ == 4;
  int channel = 0;
  double alpha = 1.0;
  for (size_t i = 0; i < stored.size(); ++i) {
    const uint32_t bits = stored[i];
    if (divides && channel == 0) {
      alpha = value_of_code(layout_, 3, stored[i + 3]);
      if (!(alpha > 0.0)) alpha = 1.0;
    }
    const uint16_t code = tabulated ? of_stored_[size_t(channel)][bits] : code_of_stored(bits, channel, alpha);
    if (wide) *out++ = uint8_t(code >> 8);
    *out++ = uint8_t(code);
    channel = channel + 1 == channels_ ? 0 : channel + 1;
  }
}

}  // namespace trueshade
