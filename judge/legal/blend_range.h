#pragma once
// From what a fragment may output and what a pixel may hold to what the pixel may hold afterwards (docs/gl_rules.md
// section 4).
#include <array>

#include "core/blend_state.h"
#include "judge/legal/store.h"

namespace trueshade::oracle {

/// What each channel of a pixel may hold: codes for fixed-point formats, values for others. Channels that a format
/// lacks are not read.
using Texel = std::array<LegalTexel, 4>;

/// The set that holds `stored` and nothing else.
LegalTexel known_texel(double stored);

/// What a pixel may hold once one fragment is blended or, where blending is off, stored. Channels that are masked off
/// keep what they may hold. A result that is NaN, which OpenGL leaves open (2.3.4), gives an infinite range.
///   source: what the fragment may output in each channel, alpha last, before any clamp
///   stored: what the pixel may hold before
/// The profile's BlendRule decides. any_precision (GL 4.6 core, 17.3.6): sources, factors and constants are clamped for
/// fixed point; each of them, each product and the result may be a neighbour in the target's own format, or none
/// rounded at all. Each step is the hull of an interval, so what is read twice (a destination that is a factor too) may
/// come out wider than the set is; it never comes out narrower. sRGB targets are blended in linear values, each within
/// kSrgbDecodeError of its code's unless the profile is exact.
Texel blended_texel(const BlendState& state, Format format, const Profile& profile, const std::array<Range, 4>& source,
                    const Texel& stored);

/// What the pixel may hold where the driver blends as `likely` says: in float32, rounded once to the likelier
/// neighbour, codes added under ONE, ONE; or in products of codes, as llvmpipe. Its second_chance bounds how often such
/// a driver stores the other neighbour. A profile that states its BlendRule, any_precision apart, is followed instead,
/// and `likely` is not read. For the statistical tests of the whole image.
///   likely: following(profile.likely, profile)
Texel likely_texel(const BlendState& state, Format format, const Profile& profile, const Profile& likely,
                   const std::array<Range, 4>& source, const Texel& stored);

/// The largest error found in drivers' decoding of an sRGB code, as a linear value (docs/data/drivers.md, stores), with
/// room for the rounding of what was measured.
inline constexpr double kSrgbDecodeError = 1.3e-3;

/// The smallest set that holds both; its nominal value is that of `a`.
LegalTexel hull(const LegalTexel& a, const LegalTexel& b);

}  // namespace trueshade::oracle
