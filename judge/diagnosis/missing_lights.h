#pragma once
// Lights whose terms a picture lacks, at some of its pixels or at all of them.
#include <optional>

#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// Explains a picture by lights that are missing, everywhere or at some pixels as in a shadow. Of the 64 lights that
/// add most it chooses up to four, one after the other, by how much their absence explains. Nothing where a fifth of
/// the difference or more is left.
std::optional<LightQuotient> missing_lights(const LightShares& shares);

}  // namespace trueshade::oracle
