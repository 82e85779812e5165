#pragma once
#include "core/image.h"
#include "gl/driver/objects.h"

namespace trueshade::oracle {

/// The rectangle of `texture` that starts at window pixel (x, y), rows top first, stored bits as the driver hands them
/// out.
Image read_texture(GLuint texture, Format format, int x, int y, int width, int height);

}  // namespace trueshade::oracle
