#pragma once
// What a filter may make of one level of a texture, over a box of texture coordinates.
#include <algorithm>
#include <cmath>

#include "judge/bounds/level_hulls.h"
#include "judge/legal/store.h"
#include "oracle/texture_lookup.h"

namespace trueshade::oracle {

using TexelHull = std::array<Range, 4>;  ///< of R, G, B, A; `value` is not set

/// A hull that holds nothing, for include().
TexelHull no_texel();
/// Widens a hull so that it holds the other too.
void include(TexelHull& hull, const TexelHull& other);

/// A linear number encoded as sRGB, not clamped; NaN stays NaN.
template <class Real>
Real srgb_encoded(Real x) {
  return x <= Real(0.0031308L) ? Real(12.92L) * x : Real(1.055L) * std::pow(x, Real(1 / 2.4L)) - Real(0.055L);
}
/// An sRGB number decoded, clamped to [0, 1].
template <class Real>
Real srgb_decoded(Real s) {
  if (s <= Real(0.04045L)) return std::max(Real(0), s) / Real(12.92L);
  return std::pow((std::min(s, Real(1)) + Real(0.055L)) / Real(1.055L), Real(2.4L));
}

/// srgb_decoded() as Mesa 22.3 computes it (gallium/auxiliary/gallivm/lp_bld_format_srgb.c): a line, and a polynomial
/// from code 16 on.
long double mesa_decoded(long double s);

/// The levels of a texture, read as a sampler may: sRGB texels as decoded, some codes off, or not decoded yet.
struct TexelSource {
  const Texture& texture;
  const Sampler& sampler;
  const Sampling& rules;
  LevelHulls* hulls;
  bool encoded = false;
  double codes = 0;

  /// What a hull of a level read so is of.
  LevelReading reading(size_t level) const;
  /// The texel by its indices before wrapping.
  TexelValue at(size_t level, long long i, long long j) const;
  /// The texel by its indices as wrapped_index() has them.
  TexelValue at_wrapped(size_t level, long long x, long long y) const;
};

/// The hull of what the filter may give where the coordinates lie in u and v, the weights as far off as the rules let
/// them be. Boxes of many texels are taken for the whole level.
///   exact: coordinates and weights are exact
TexelHull level_range(const TexelSource& texels, size_t level, Filter filter, const Range& u, const Range& v,
                      bool exact);

}  // namespace trueshade::oracle
