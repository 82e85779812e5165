#pragma once
#include <array>
#include <cstdint>

#include "core/image.h"

namespace trueshade {

// G-buffer planes as 8-bit pictures to look at. Nothing is measured from these; `depth` is the d32f plane of the same
// frame, and a pixel is empty where it holds `clear_depth`. Empty pixels come out as kEmptyColor.
inline constexpr std::array<uint8_t, 3> kEmptyColor{24, 26, 31};

Image normal_view(const Image& normal, const Image& depth, float clear_depth);      ///< (N + 1) / 2
Image position_view(const Image& position, const Image& depth, float clear_depth);  ///< each axis over its own extent
Image albedo_view(const Image& albedo, const Image& depth, float clear_depth);      ///< sRGB-encoded
Image depth_view(const Image& depth,
                 float clear_depth);  ///< near is bright; by the logarithm of 1 - depth, as distance goes

/// Counts in the colours of heat_color(), from 0 to `most`.
Image heat_view(const Image& counts, uint32_t most);
uint32_t largest_count(const Image& counts);

/// A ramp from dark blue through red to light yellow, rising in brightness; `share` in [0, 1].
std::array<uint8_t, 3> heat_color(double share);

}  // namespace trueshade
