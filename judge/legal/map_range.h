#pragma once
// What the maps of a material may make of a piece at a sample.
#include <optional>

#include "judge/legal/texture_range.h"

namespace trueshade::oracle {

/// Where a material's map is read at a sample (x, y) of a piece. `slot` must be used.
TextureSample map_sample(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                         const SurfacePoint& point, const TriangleValues& values, double x, double y);

/// What a material's map may give at a sample: R, G, B, A; nothing where the slot is empty.
std::optional<std::array<Range, 4>> map_texel(const Projector& projector, const TextureSlot& slot, const Piece& piece,
                                              const SurfacePoint& point, const TriangleValues& values, double x,
                                              double y);

/// a * b for ranges of any sign, with the arithmetic's rounding.
Range product(const Range& a, const Range& b, const Profile& profile);

/// Which ways the alpha test of a masked material may go.
struct AlphaVerdict {
  bool may_keep = true, may_drop = false, nominal_keeps = true;
};

/// Holds the alpha of a masked material at a sample (x, y) against the cutoff. Looks the colour map up.
AlphaVerdict alpha_verdict(const Projector& projector, const Material& material, const Piece& piece,
                           const SurfacePoint& point, const TriangleValues& values, double x, double y);

}  // namespace trueshade::oracle
