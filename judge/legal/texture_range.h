#pragma once
// What a texture lookup may give: the union over the places, levels of detail and weights that a profile leaves open
// (docs/gl_rules.md sections 5 and 9). The class TEX.
#include <array>

#include "judge/bounds/level_hulls.h"
#include "judge/legal/surface.h"
#include "oracle/texture_lookup.h"

namespace trueshade::oracle {

/// The texture coordinates of a piece at one sample, and the derivatives that a lookup there may have.
struct TextureSample {
  Range u, v;                ///< texture coordinates
  TexturePlace nominal;      ///< and their derivatives in the middle of what is open
  TexturePlace least, most;  ///< |derivatives| over the sample and its neighbours: a GPU takes differences in a quad
};

/// The texture coordinates of a piece at the sample (x, y), pixels, and their derivatives.
///   uv:   u and v at the piece's three vertices
///   u, v: their ranges at the sample
TextureSample texture_sample(const Piece& piece, const std::array<std::array<double, 3>, 2>& uv, Interpolation how,
                             const Range& u, const Range& v, double x, double y);

/// The RGBA that a lookup may return: nominal value, and the least and largest over all coordinates of the sample and
/// over all that Profile::sampling leaves open.
///   hulls: if not null, keeps what is found of whole levels for other lookups; never changes a value
std::array<Range, 4> texel_range(const Texture& texture, const Sampler& sampler, const TextureSample& sample,
                                 const Profile& profile, LevelHulls* hulls = nullptr);

}  // namespace trueshade::oracle
