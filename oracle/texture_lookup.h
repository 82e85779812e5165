#pragma once
// Texture lookups as OpenGL writes them (GL 4.6 core, 8.14 and 8.15), in long double, one texel at a time. Shares no
// arithmetic with the renderer.
#include <array>

#include "scenes/texture.h"

namespace trueshade::oracle {

using TexelValue = std::array<long double, 4>;

/// An index of texels wrapped (table 8.20); -1 or `side`: the border.
long long wrapped_index(Wrap how, long long index, int side);

/// A texel by its index before wrapping: the float nearest to what is stored, or the border colour.
TexelValue wrapped_texel(const Texture& texture, const Sampler& sampler, size_t level, long long i, long long j);

/// The texel whose index a texture coordinate gives, real arithmetic: floor(coordinate * side).
long long texel_index(long double coordinate, int side);

/// Place in a texture and its change from pixel to pixel, in units of u and v.
struct TexturePlace {
  long double u, v, u_x, v_x, u_y, v_y;
};

/// Equations 8.8 to 8.11: log2 of the longer side of the pixel in texels, biased and clamped. -infinity where nothing
/// moves and nothing clamps.
long double level_of_detail(const Texture& texture, const Sampler& sampler, const TexturePlace& place);

/// What OpenGL allows for log2 rho, before bias and clamp: from the largest derivative to sqrt(2) times the sum of the
/// larger ones along u and v (8.14.1).
struct LodRange {
  long double low, high;
};
LodRange legal_lod(const Texture& texture, const TexturePlace& place);

/// The filter's result at a level of detail. `weight_bits`: the fractional bits of the weights of texels and levels,
/// rounded to nearest even; 0: exact (docs/gl_rules.md section 5, d3d-class has 8).
TexelValue filtered(const Texture& texture, const Sampler& sampler, long double u, long double v, long double lod,
                    int weight_bits = 0);

}  // namespace trueshade::oracle
