#pragma once
#include <cstdint>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade::viewer {

/// Turns pictures into the codes that a screen shows: those that a PNG of the picture holds, of 8 bits a channel. Keeps
/// its tables from one picture of a format to the next.
class DisplayCodes {
 public:
  /// Words 0x00RRGGBB, rows top first. `values`: what the picture's numbers stand for. Needs a format with R, G and B.
  void convert(const Image& image, PictureValues values, std::vector<uint32_t>& out);

 private:
  void make_table(Format format, PictureValues values);

  std::vector<uint8_t> of_code_;  // of a channel of up to 16 bits, which R, G and B have alike
  Format format_{};
  PictureValues values_{};
};

}  // namespace trueshade::viewer
