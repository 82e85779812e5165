#pragma once
#include "cli/capture/capture_files.h"
#include "core/image.h"

namespace trueshade {

/// The index, in the channels of the plane's file, of pixel (x, y) of the picture; y from the top.
inline size_t file_pixel(const PlaneChannelList& plane, int x, int y) {
  const int row = plane.mapped.bottom_up ? plane.file->height - 1 - y : y;
  return size_t(row) * size_t(plane.file->width) + size_t(x);
}

/// A plane as its channels have it: codes of 8, 10 and 16 bits in four channels and halves in three and four stay what
/// they are, other codes become the floats k / largest, other floats float32; one integer stays one. A picture of three
/// codes gets a fourth, of alpha 1. Error(bad_input) naming the pixel (from the top left): a NaN in a plane other than
/// `color`; of integers in a plane that has several channels.
Image stored_plane_image(const PlaneChannelList& plane);

}  // namespace trueshade
