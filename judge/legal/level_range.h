#pragma once
// What a filter may make of one level of a texture, over a box of texture coordinates.
#include <algorithm>
#include <cmath>

#include "judge/bounds/level_hulls.h"
#include "judge/legal/store.h"
#include "oracle/texture_lookup.h"

namespace trueshade::oracle {

using TexelHull = std::array<Range, 4>;  ///< of R, G, B, A; `value` is not set

/// An empty hull, to which include() adds.
TexelHull no_texel();
/// Widens `hull` to hold `other` too.
void include(TexelHull& hull, const TexelHull& other);

/// A linear value encoded as sRGB, 0 to 1 as 0 to 1. Not clamped; NaN stays NaN.
template <class Real>
Real srgb_encoded(Real x) {
  return x <= Real(0.0031308L) ? Real(12.92L) * x : Real(1.055L) * std::pow(x, Real(1 / 2.4L)) - Real(0.055L);
}
/// The linear value of an sRGB one, which is clamped to [0, 1].
template <class Real>
Real srgb_decoded(Real s) {
  if (s <= Real(0.04045L)) return std::max(Real(0), s) / Real(12.92L);
  return std::pow((std::min(s, Real(1)) + Real(0.055L)) / Real(1.055L), Real(2.4L));
}

/// srgb_decoded() as Mesa 22.3 computes it (gallium/auxiliary/gallivm/lp_bld_format_srgb.c): a line below code 16, a
/// polynomial from there.
long double mesa_decoded(long double s);

/// A texture's levels as a sampler may read them: sRGB texels not decoded yet where `encoded`, else decoded with an
/// error of up to `codes` codes of 255. Borrows all.
struct TexelSource {
  const Texture& texture;
  const Sampler& sampler;
  const Sampling& rules;
  LevelHulls* hulls;
  bool encoded = false;
  double codes = 0;

  /// The key of the hull of a level that is read in this way.
  LevelReading reading(size_t level) const;
  /// The texel at column i and row j, which the sampler wraps into the level.
  TexelValue at(size_t level, long long i, long long j) const;
  /// The texel at indices that wrapped_index() has wrapped.
  TexelValue at_wrapped(size_t level, long long x, long long y) const;
};

/// The least and largest RGBA that the filter may return for texture coordinates in u and v, with weights as far off as
/// texels.rules allow. A box of many texels gives the hull of the whole level.
///   exact: coordinates and weights are exact
TexelHull level_range(const TexelSource& texels, size_t level, Filter filter, const Range& u, const Range& v,
                      bool exact);

}  // namespace trueshade::oracle
