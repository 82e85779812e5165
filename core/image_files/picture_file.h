#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/image_files/channel_file.h"
#include "core/image_files/image_io.h"

namespace trueshade {

/// What the numbers of colours stand for (docs/color.md).
enum class ColorSpace : uint8_t { linear, srgb };

/// A picture of any kind, with all that its file holds.
struct PictureFile {
  std::string path;
  std::string_view kind;           ///< as picture_kind() names it, or "NumPy"
  std::vector<ChannelFile> parts;  ///< one, but for an EXR of several; they may differ in size
  Metadata metadata;               ///< of PNG and EXR, that of the first part
  ColorSpace color_space = ColorSpace::linear;
  std::string color_source;  ///< what says so: "its sRGB chunk", or what was assumed
};

/// Reads a picture of any kind that core/image_files has a reader for: EXR (scan lines or tiles, the first level; parts
/// of several sizes; any data window), PNG, TIFF, DDS, .npy, Radiance HDR, JPEG. The first bytes tell the kind. `-` is
/// standard input.
/// Errors as read_channel_file() has them.
PictureFile read_any_picture(const std::string& path, uint64_t most_expansion);

/// Decodes all of a PNG and keeps none of it, so that it may be of any size. Errors as read_any_picture() has them of a
/// PNG that is damaged.
void check_png(const std::string& path, uint64_t most_expansion);

}  // namespace trueshade
