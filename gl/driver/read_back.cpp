#include "gl/driver/read_back.h"

#include <algorithm>
#include <array>

namespace trueshade::oracle {

Image read_texture(GLuint texture, Format format, int x, int y, int width, int height) {
  const bool depth = format == Format::d32f;
  const std::array<GLuint, 1> colors{texture};
  const GlTarget target = make_target(std::span<const GLuint>(colors.data(), depth ? 0 : 1), depth ? texture : 0);
  Image image(width, height, format);
  const GlFormat gl = gl_format(format);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
  glReadPixels(x, y, width, height, gl.external, gl.type, image.texels.data());
  check_gl("reading back");
  // GL's first row is the window's lowest.
  const auto row = std::ptrdiff_t(image.row_bytes());
  for (std::ptrdiff_t top = 0, bottom = height - 1; top < bottom; ++top, --bottom)
    std::swap_ranges(image.texels.begin() + top * row, image.texels.begin() + (top + 1) * row,
                     image.texels.begin() + bottom * row);
  return image;
}

}  // namespace trueshade::oracle
