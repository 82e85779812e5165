#pragma once
// Conversions of values to unorm codes: where the code changes from one to the next, as an image shows it.
#include <optional>
#include <span>

#include "judge/legal/store.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

/// A value whose conversion to a code may give either of two codes, by a rule that rounds within `reach` codes; nothing
/// where only one code is possible.
///   range: the value in [0, 1], before it is scaled by `largest`; the rounding of the product is added here
///   before: the code that the result is added to; 0 where it is stored
/// Leaves `sum_of` and `uppers` to the caller.
std::optional<NearThreshold> near_threshold(const Range& range, double largest, double reach, uint32_t before,
                                            int channel);

/// Whether the target's conversions to codes are worth testing: the likely rule may round to a code more than half a
/// code away, and codes are neither of sRGB, nor llvmpipe's, nor of sums kept in floats.
bool converts_as_seen(const PlaneView& target, const Profile& profile);

/// How many stores contradict every nondecreasing conversion of values to codes, at least, whatever the thresholds
/// between codes (D3D11.3 functional spec, 3.2.3.6: conversions to integers do not decrease). Values are anywhere
/// between their bounds; equal ones count once. Which way each conversion of a sum went is known where all went one
/// way, or where the thresholds that other sums show leave one outcome; a sum that these exclude counts as one. What is
/// converted may be what each draw adds, or the sum that the target becomes: returns the lesser number of both.
double crossed_stores(std::span<const NearThreshold> stores);

}  // namespace trueshade::oracle
