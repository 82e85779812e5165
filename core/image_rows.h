#pragma once
#include "core/image.h"

namespace trueshade {

/// How many rows a thread reads or paints at a time.
inline constexpr int kRowsOfBand = 16;

/// Image::value() of one code, for loops over texels: needs FpScope, which they open once.
double value_of_code(const FormatInfo& layout, int channel, uint32_t code);

/// Image::value() of `channels` channels of each texel of a row, as floats: out[channels * x + c]. Needs FpScope. The
/// format is not r32ui, whose values floats do not hold; `y` counts from the top.
void read_row(const Image& image, int y, int channels, float* out);

/// The words of a row of r32ui.
void read_row(const Image& image, int y, uint32_t* out);

}  // namespace trueshade
