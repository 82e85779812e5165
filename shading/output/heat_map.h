#pragma once
#include <array>
#include <cstdint>

#include "core/image.h"

namespace trueshade {

/// A colour map whose lightness rises evenly: CIE L* from 3 to 97 in steps that never turn back
/// (tests/shading/views.cpp), from near black through blue, magenta, red and orange to pale yellow. `step` in [0, 256].
/// sRGB codes.
std::array<uint8_t, 3> heat_color(int step);

/// What the top of the colour map stands for: the least power of two that no count exceeds, at least 1.
uint32_t heat_scale(const Image& counts);

/// Counts (r32ui) in these colours: step floor(256 count / scale). rgba8, the same on any number of threads.
Image heat_image(const Image& counts, uint32_t scale, int threads = 1);

}  // namespace trueshade
