#pragma once
// Where a conversion to codes changes from one code to the next, as an image shows it.
#include <optional>
#include <span>

#include "judge/legal/store.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

/// A value that is converted to codes, if a conversion within `reach` of them may give either of two; nothing where it
/// can give one alone.
///   range: before it is scaled by `largest`; what rounding the product may add is added here
///   before: the code that the result is added to; 0 where it is stored
/// `sum_of` and `uppers` are left to the caller.
std::optional<NearThreshold> near_threshold(const Range& range, double largest, double reach, uint32_t before,
                                            int channel);

/// Whether a target's conversion to codes is looked at: by a rule that reaches beyond half a code, of codes that are
/// not those of sRGB.
bool converts_as_seen(const PlaneView& target, const Profile& profile);

/// The least number of stores that no nondecreasing conversion makes, whatever its thresholds (D3D11.3 functional
/// spec, 3.2.3.6: conversions to integers do not decrease). Values are anywhere between their bounds; equal ones count
/// once. Which way each conversion of a sum went is told where all went one way, or where the thresholds that other
/// sums show leave one outcome; a sum that these rule out counts as one. The conversion may be of what is added, or of
/// what the sum becomes: of both the lesser number.
double crossed_stores(std::span<const NearThreshold> stores);

}  // namespace trueshade::oracle
