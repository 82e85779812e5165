#pragma once
#include <glm/vec4.hpp>

#include "shading/blend/blend.h"

namespace trueshade {

/// Whether a draw may store a colour otherwise than a clear to it: of llvmpipe's targets those of 16 bits and of ten,
/// which draws store by way of 16, and of sRGB codes. Then a tile is brought to its stored form before it is written.
bool draws_unlike_clears(const BlendTarget& target);

/// The colour that a draw stores as what a clear to `color` leaves (docs/arithmetic.md section 11): `color` itself, or
/// the value of the codes it is cleared to.
glm::vec4 drawn_clear(const glm::vec4& color, const BlendTarget& target);

}  // namespace trueshade
