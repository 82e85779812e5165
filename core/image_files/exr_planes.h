#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image_files/image_io.h"

namespace trueshade {

/// read_image_info() and read_planes() of an EXR's bytes, by OpenImageIO. Errors name `path` as theirs do.
ImageFileInfo exr_header(const std::string& path, std::span<const uint8_t> bytes);
std::vector<NamedImage> exr_planes(const std::string& path, std::span<const uint8_t> bytes);

}  // namespace trueshade
