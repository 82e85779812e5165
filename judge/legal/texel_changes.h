#pragma once
// What a lookup nominally gives, and how that changes with what implementations choose, and with what people get wrong.
#include <array>
#include <optional>

#include "judge/legal/texture_range.h"

namespace trueshade::oracle {

/// How an implementation reads textures where GL leaves it a choice, one way for a whole picture.
struct TexelWay {
  double rho = 0;  ///< -1: rho is the largest derivative, the least that 8.14.1 allows; 0: equation 8.11; 1: the sum of
                   ///< the larger derivatives along u and v; log2 rho lies in proportion between
  bool late = false;  ///< sRGB is filtered before it is decoded
  bool mesa = false;  ///< sRGB is decoded by Mesa's polynomial
};

/// What may be different in all lookups of a map, through a choice or a mistake, as one number for the whole picture.
enum class TexelCause : uint8_t {
  gain,     ///< relative: RGB times 1 + a; of a normal map the scale of x and y
  level,    ///< levels that log2 rho is more
  rho,      ///< TexelWay::rho is more
  shift_u,  ///< texels of the level that is read
  shift_v,
  step,  ///< codes of 255 that each linear step between unequal texels is off on average: -0.5 where it truncates
  order  ///< 1: sRGB is filtered before it is decoded where the way says after, or after where it says before
};
inline constexpr size_t kTexelCauses = 7;

/// A texel, R G B A, and how much it changes for one unit of each cause.
struct TexelChanges {
  using Rgba = std::array<double, 4>;
  Rgba texel{};                             ///< by the way
  std::array<Rgba, kTexelCauses> change{};  ///< of the texel, for one unit of each cause
};

/// What a lookup gives where textures are read by `way`, and how that changes with each cause. Nothing where it is not
/// sure which filter applies, or which texel is nearest, as the nominal texel then says little.
///   normals: the texture is a normal map
std::optional<TexelChanges> texel_changes(const Texture& texture, const Sampler& sampler, const TexturePlace& place,
                                          bool normals, const TexelWay& way);

}  // namespace trueshade::oracle
