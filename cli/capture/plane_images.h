#pragma once
#include "cli/capture/capture_files.h"
#include "core/image.h"

namespace trueshade {

/// The index of pixel (x, y) of the picture, y from the top, in the channels of the plane's file.
inline size_t file_pixel(const PlaneChannelList& plane, int x, int y) {
  const int row = plane.mapped.bottom_up ? plane.file->height - 1 - y : y;
  return size_t(row) * size_t(plane.file->width) + size_t(x);
}

/// A plane as an image, the picture's first row first. Codes of 8, 10 and 16 bits in four channels, and halves in three
/// and four, keep their format. Other codes become the floats k / largest, other floats become float32; one integer
/// stays one. A plane of three codes of 8 or 16 bits gets a fourth channel, alpha 1, unless it is a position or a
/// normal. Error(bad_input), naming the pixel (from the top left), for a NaN in a plane other than `color`; and for
/// integers in a plane that is no identifier and no count. Infinity stays.
Image stored_plane_image(const PlaneChannelList& plane);

}  // namespace trueshade
