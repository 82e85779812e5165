#pragma once
#include "core/image.h"
#include "gl/driver/objects.h"

namespace trueshade::oracle {

/// Reads a rectangle of `texture` whose lower left pixel is (x, y) in the window. The image has the top row first, and
/// the bits that the driver hands out.
Image read_texture(GLuint texture, Format format, int x, int y, int width, int height);

}  // namespace trueshade::oracle
