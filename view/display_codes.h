#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade::viewer {

/// Turns pictures into the codes that a screen shows: those that a PNG of the picture holds, of 8 bits a channel. Keeps
/// its tables from one picture of a format to the next.
class DisplayCodes {
 public:
  /// Words 0x00RRGGBB, rows top first. `values`: what the picture's numbers stand for. Needs a format with R, G and B.
  /// None for a picture that holds its codes (holds_display_codes()), where `display` does nothing.
  void convert(const Image& image, PictureValues values, const DisplayTransform& display, std::vector<uint32_t>& out);

 private:
  void make_table(Format format, PictureValues values, const DisplayTransform& display);

  std::vector<uint8_t> of_code_;  // of a channel of up to 16 bits, which R, G and B have alike
  Format format_{};
  PictureValues values_{};
  DisplayTransform display_{};
};

/// Whether the texels are four bytes R, G, B, A, which a screen shows as they are.
bool holds_display_codes(const Image& image);

/// Words 0x00RRGGBB of the pixels from (x, y), y from the top, of one row. `words`: what convert() made of the image.
void read_words(const Image& image, const std::vector<uint32_t>& words, int x, int y, std::span<uint32_t> out);

}  // namespace trueshade::viewer
