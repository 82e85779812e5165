#pragma once
#include <array>

#include "shading/blend/blend.h"

namespace trueshade {

/// A pixel in a target's stored form, as blend_pixels() has it: codes as floats, or the floats themselves.
using StoredPixel = std::array<float, 4>;

/// What a pixel that holds `stored` holds after one draw of `source`: blend_pixels() for one pixel.
StoredPixel after_draw(const BlendState& state, const BlendTarget& target, const std::array<float, 4>& source,
                       const StoredPixel& stored);

/// What a draw of `source` without blending stores.
StoredPixel stored_alone(const BlendTarget& target, const std::array<float, 4>& source);

/// What a shader reads of a stored pixel: R, G, B, A.
std::array<float, 4> values_of(const BlendTarget& target, const StoredPixel& stored);

}  // namespace trueshade
