#pragma once
#include <array>

#include "shading/blend/blend.h"

namespace trueshade {

/// A pixel in a target's stored form, as blend_pixels() takes it: unorm codes as floats, or the floats themselves.
using StoredPixel = std::array<float, 4>;

/// What a pixel holds after a draw with this source colour, if it held `stored` before: blend_pixels() for one pixel.
StoredPixel after_draw(const BlendState& state, const BlendTarget& target, const std::array<float, 4>& source,
                       const StoredPixel& stored);

/// What a pixel holds after a draw with this source colour without blending.
StoredPixel stored_alone(const BlendTarget& target, const std::array<float, 4>& source);

/// The R, G, B, A that a shader reads from a stored pixel.
std::array<float, 4> values_of(const BlendTarget& target, const StoredPixel& stored);

}  // namespace trueshade
