#pragma once
// From the interval a value lies in to the texels it may be stored as (docs/gl_rules.md section 3).
#include <cmath>

#include "core/format.h"
#include "judge/bounds/profile.h"

namespace trueshade::oracle {

/// What a shader may output in one channel: the nominal value, and the least and the largest one.
struct Range {
  double value = 0, low = 0, high = 0;
};

inline constexpr Range kAnyValue{0, -HUGE_VAL, HUGE_VAL};

/// The range of a bounded number, from value - error to value + error.
inline Range range_of(const Bounded& b) { return {b.value, b.low(), b.high()}; }

/// What one channel may legally hold after a store, as it reads back (unorm: in codes, 0..255): all from low to high.
struct LegalTexel {
  double nominal = 0;  ///< what the store gives for Range::value; unorm and half: on the grid
  double low = 0, high = 0;
  double second_chance = 0;  ///< predicted probability that the likely rule does not store the nominal value, errors
                             ///< uniform in the range
  int second_side = 0;       ///< where the likelier other value lies: -1 below, 1 above
  bool either_side = false;  ///< whether there are other values on both sides
  /// Whether every stored value is legal, NaN too, because nothing is known of what was output.
  bool is_open() const { return low != low || high != high || (low == -HUGE_VAL && high == HUGE_VAL); }
  /// Whether a stored value is legal. NaN is legal only where is_open().
  bool contains(double stored) const { return (stored >= low && stored <= high) || is_open(); }
};

/// What a channel of `format` may hold after the shader's output, anywhere in `range`, is stored.
///   Unorm: codes c with |c - largest x| <= reach (reach 1: < 1, GL 4.6 core 2.3.5.2), x clamped to [0, 1], the
///          product's rounding to float included
///   sRGB: the same of the encoded value with Profile::srgb_reach; GL's own exponent of 0.41666 (17.3.7) is 0.002 off.
///         For llvmpipe the nominal code is llvmpipe's own (core/llvmpipe_srgb.h)
///   Half: by the profile's mode, finite overflow to 65504 or infinity as the mode says
///   11 and 10 bits: as half, but negative values are 0 and finite ones stay below infinity
///   Float: the range itself, its ends moved outward to floats
/// An end of the range that is NaN counts as infinite. Where both ends are infinite, a float may hold NaN too.
LegalTexel legal_texel(const Range& range, Format format, int channel, const Profile& profile);
/// What a channel of 32-bit floats, or of integers, may hold for an output in `range`: all of the range, with its ends
/// moved outward to floats.
LegalTexel legal_float(const Range& range);

/// The profile with the rule's way to store and to blend put in wherever the profile leaves it open.
Profile following(const StoreRule& rule, const Profile& profile);

/// The output of a draw that would leave in a channel what a clear to `color` leaves. llvmpipe clears 10 and 16 bits by
/// rounding halves upward, and not by way of 16 bits, and sRGB by a table of its own (docs/arithmetic.md section 11);
/// elsewhere it is the colour itself.
Range cleared_range(double color, Format format, int channel, const Profile& profile);

/// Whether a driver of `profile` makes the codes of `format` from codes of 16 bits, those of rgba16, as llvmpipe does
/// for formats of 10 and 2 bits (docs/arithmetic.md section 11).
bool computes_in_16_bits(Format format, const Profile& profile);
/// The 16-bit codes that stored codes of 10 bits (channel 3: of 2 bits) stand for, made by repeating their bits.
LegalTexel widened(const LegalTexel& stored, int channel);
/// The codes of 10 bits (channel 3: of 2 bits) that llvmpipe stores for 16-bit codes, not always the nearest ones.
LegalTexel narrowed(const LegalTexel& wide, int channel);

}  // namespace trueshade::oracle
