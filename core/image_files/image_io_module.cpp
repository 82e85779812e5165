#include "core/image_files/image_io_table.h"

/// The module's only export (core/image_files/image_io_table.h).
extern "C" __attribute__((visibility("default"))) const trueshade::ImageIoTable* trueshade_image_io_table() {
  static const trueshade::ImageIoTable table{trueshade::write_image, trueshade::encode_png, trueshade::decode_image,
                                             trueshade::read_image_info, trueshade::read_planes};
  return &table;
}
