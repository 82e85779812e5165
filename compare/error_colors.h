#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "core/image.h"

namespace trueshade::compare {

/// Errors in [0, 1] as a picture: black, violet, orange, pale yellow, ever lighter, for people who see colours
/// otherwise too.
Image error_picture(std::span<const float> map, int width, int height);

/// The colour of one error, codes of sRGB.
std::array<uint8_t, 3> error_color(float error);

}  // namespace trueshade::compare
