#include "core/image_files/image_io_table.h"

/// The module's only export (core/image_files/image_io_table.h).
extern "C" __attribute__((visibility("default"))) const trueshade::ImageIoTable* trueshade_image_io_table() {
  static const trueshade::ImageIoTable table{trueshade::exr_header, trueshade::exr_planes, trueshade::jpeg_pixels,
                                             trueshade::exr_part_channels};
  return &table;
}
