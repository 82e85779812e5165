#pragma once
// Lights whose terms a picture lacks, at some of its pixels or at all of them.
#include <optional>

#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// What explains a picture as lights that are there at some pixels and missing at others, as behind what stands in
/// their way: one after the other, those whose absence explains most. Nothing where more than next to nothing is left.
std::optional<LightQuotient> missing_lights(const LightShares& shares);

}  // namespace trueshade::oracle
