#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image_files/channel_file.h"
#include "core/image_files/image_io.h"

namespace trueshade {

/// read_image_info() and read_planes() of an EXR's bytes, by OpenImageIO. Errors name `path` as theirs do. Of
/// read_channel_file() see channel_file.h.
ImageFileInfo exr_header(const std::string& path, std::span<const uint8_t> bytes);
std::vector<NamedImage> exr_planes(const std::string& path, std::span<const uint8_t> bytes);

}  // namespace trueshade
