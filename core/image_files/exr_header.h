#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image_files/exr_rows.h"
#include "core/image_files/image_io.h"

namespace trueshade {

/// What the header of an EXR says of the picture.
struct ExrPicture {
  int width, height;                                      ///< pixels
  Format color;                                           ///< of the target, whose values the colour space is of
  std::vector<std::pair<std::string, ExrType>> channels;  ///< by name
  int tile = 0;                                           ///< pixels a side; 0: scan lines
};

/// Bytes from the file's first to the zero that ends the attributes. Error(usage) naming `where` for names longer than
/// 255 bytes.
std::vector<uint8_t> exr_header_bytes(const std::string& where, const ExrPicture& picture, const Metadata& metadata,
                                      const ImageFileOptions& options);

}  // namespace trueshade
