#pragma once
#include <cstdint>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// What a PNG says its codes stand for.
enum class PngTag : uint8_t {
  srgb,    ///< chunks sRGB and gAMA 1/2.2: codes as screens take them
  linear,  ///< chunk gAMA 1.0: codes proportional to light
};

/// The sRGB value of a linear value in [0, 1] (IEC 61966-2-1), the same bits everywhere: x^(5/12) is the fifth power of
/// a root that Newton's method finds.
double srgb_from_linear(double linear);

/// The light that a screen is to show of a target's value: curve(scale x) in [0, 1]. NaN and what is below 0 give 0.
/// filmic: y (2.51 y + 0.03) / (y (2.43 y + 0.59) + 0.14) of y = 0.6 scale x, Narkowicz' fit with his factor for the
/// brightness of ACES.
double shown_light(double value, const DisplayTransform& display);
/// The value whose shown_light() is this one, in [0, 1].
double light_behind(double shown, const DisplayTransform& display);

/// The codes that a PNG holds for an image. This class defines the rule of image_io.h: which transfer function a
/// channel's values pass, and to how many bits they are rounded.
class PngCodes {
 public:
  PngCodes(const Image& image, const ImageFileOptions& options);

  int channels() const { return channels_; }
  int bits() const { return bits_; }  ///< of a channel, 8 or 16
  PngTag tag() const { return tag_; }
  size_t row_bytes() const { return size_t(image_.width) * size_t(channels_) * size_t(bits_ / 8); }

  /// Codes of a row, pixel after pixel, R first; the more significant byte of 16 bits first. `y` counts from the top.
  void row(int y, uint8_t* out) const;

 private:
  enum class Transfer : uint8_t { stored_code, srgb, none };

  static Transfer transfer_of(const FormatInfo& layout, const ImageFileOptions& options, bool transforms);
  static Transfer transfer_without_transform(const FormatInfo& layout, const ImageFileOptions& options);
  uint16_t code_of_value(double value, Transfer transfer) const;
  uint16_t code_of_stored(uint32_t stored, int channel, double alpha = 1.0) const;
  std::vector<uint16_t> table_of(int channel) const;

  const Image& image_;
  FormatInfo layout_;
  int channels_, bits_;
  DisplayTransform display_;
  Transfer transfer_;
  PngTag tag_;
  bool as_stored_;                                ///< the image's bytes are the PNG's
  std::vector<std::vector<uint16_t>> of_stored_;  ///< a table for each channel, empty where one has more than 16 bits
};

}  // namespace trueshade
