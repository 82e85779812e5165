#pragma once
#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// Where one of the known falloffs leaves as little as the curve, or less, it is the better description.
///   q: by distance; gets its text and what is left
void name_falloff(const LightShares& shares, LightQuotient& q);

}  // namespace trueshade::oracle
