#pragma once
// The functions that need OpenImageIO, as a table that a module hands out. A program that may end without reading an EXR
// or a JPEG loads the module when it first does: OpenImageIO costs every start 0.3 s and 130 MB.
#include "core/image_files/exr_planes.h"
#include "core/image_files/jpeg_pixels.h"

namespace trueshade {

struct ImageIoTable {
  decltype(&trueshade::exr_header) exr_header;
  decltype(&trueshade::exr_planes) exr_planes;
  decltype(&trueshade::jpeg_pixels) jpeg_pixels;
  decltype(&trueshade::exr_part_channels) exr_part_channels;
};

/// What the module exports under this name.
using ImageIoTableFunction = const ImageIoTable* (*)();
inline constexpr const char* kImageIoTableSymbol = "trueshade_image_io_table";
inline constexpr const char* kImageIoModule = "trueshade_image_io.so";

}  // namespace trueshade
