#pragma once
// What the maps of a material may make of a piece at a sample.
#include <optional>

#include "judge/legal/texture_range.h"

namespace trueshade::oracle {

/// The texture coordinates, with their derivatives, at which a map of the material is read at the sample (x, y) of a
/// piece. `slot` must have a texture.
TextureSample map_sample(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                         const SurfacePoint& point, const TriangleValues& values, double x, double y);

/// The RGBA that a map of the material may give at the sample (x, y) of a piece; nothing where the slot has no texture.
std::optional<std::array<Range, 4>> map_texel(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                                              const SurfacePoint& point, const TriangleValues& values, double x,
                                              double y);

/// The range of a * b, a and b of any sign, with one rounding.
Range product(const Range& a, const Range& b, const Profile& profile);

/// What the alpha test of a masked material may decide at a sample.
struct AlphaVerdict {
  bool may_keep = true, may_drop = false, nominal_keeps = true;
};

/// Compares the alpha that a masked material may have at the sample (x, y) with its cutoff. Looks the colour map up.
AlphaVerdict alpha_verdict(const Projector& projector, const Material& material, const Piece& piece,
                           const SurfacePoint& point, const TriangleValues& values, double x, double y);

}  // namespace trueshade::oracle
