#include "shading/blend/clear_color.h"

#include "core/llvmpipe_srgb.h"

namespace trueshade {

bool draws_unlike_clears(const BlendTarget& target) {
  return target.profile != NumericProfile::ideal &&
         (target.format == Format::rgb10_a2 || target.format == Format::rgba16 || target.format == Format::srgb8_a8);
}

glm::vec4 drawn_clear(const glm::vec4& color, const BlendTarget& target) {
  if (!draws_unlike_clears(target)) return color;
  const FormatInfo layout = info(target.format);
  glm::vec4 drawn;
  for (int c = 0; c < 4; ++c) {
    if (layout.srgb) {
      drawn[c] = c == 3 ? color[c] : kLlvmpipeLinearOfSrgb8[size_t(llvmpipe_cleared_srgb8(color[c]))];
      continue;
    }
    const float unit = color[c] > 1.0f ? 1.0f : color[c] > 0.0f ? color[c] : 0.0f;
    const auto code = uint32_t(unit * float(layout.largest_code(c)) + 0.5f);  // halves upward
    const uint32_t wide = layout.bits[0] == 16 ? code : c == 3 ? code * 0x5555 : code << 6 | code >> 4;
    drawn[c] = float(wide) / 65535.0f;
  }
  return drawn;
}

}  // namespace trueshade
