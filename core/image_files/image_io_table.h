#pragma once
// The functions of core/image_files/image_io.h that need OpenImageIO, as a table that a module hands out. Programs that may end
// without touching an image file load the module when they first do: OpenImageIO costs every start 0.3 s and 130 MB.
#include "core/image_files/image_io.h"

namespace trueshade {

struct ImageIoTable {
  decltype(&trueshade::write_image) write_image;
  decltype(&trueshade::encode_png) encode_png;
  decltype(&trueshade::decode_image) decode_image;
  decltype(&trueshade::read_image_info) read_image_info;
  decltype(&trueshade::read_planes) read_planes;
};

/// What the module exports under this name.
using ImageIoTableFunction = const ImageIoTable* (*)();
inline constexpr const char* kImageIoTableSymbol = "trueshade_image_io_table";
inline constexpr const char* kImageIoModule = "trueshade_image_io.so";

}  // namespace trueshade
