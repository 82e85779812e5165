#pragma once
// From the interval a value lies in to the texels it may be stored as (GL_RULES section 3).
#include "core/format.h"
#include "oracle/intervals/profile.h"

namespace trueshade::oracle {

/// Values a shader may output: the most likely one and the ends.
struct Range {
  double value = 0, low = 0, high = 0;
};

inline Range range_of(const Bounded& b) { return {b.value, b.low(), b.high()}; }

/// Stored values of one channel, as they read back (unorm: in codes, 0..255): everything from low to high.
struct LegalTexel {
  double nominal = 0;        ///< what the store gives for Range::value; unorm and half: on the grid
  double low = 0, high = 0;
  double second_chance = 0;  ///< predicted probability that not the nominal value is stored, errors uniform in the range
  int second_side = 0;       ///< where the likelier other value lies: -1 below, 1 above
  bool contains(double stored) const { return stored >= low && stored <= high; }
};

/// What `format` may hold for an output in `range`.
///   rgba8: codes c with |c - 255 x| <= reach (reach 1: < 1, GL 4.6 core 2.3.5.2), x clamped to [0, 1], the product's
///   rounding to float included. Half: by the profile's mode, finite overflow to 65504 or infinity as the mode says.
///   Float: the range itself, ends moved outward to floats.
LegalTexel legal_texel(const Range& range, NumberClass number_class, int bytes_per_channel, const Profile& profile);

/// Largest half <= x and smallest half >= x, by the definition of the grid: multiples of 2^(e-10), e >= -14.
double half_below(double x);
double half_above(double x);

}  // namespace trueshade::oracle
