#pragma once
#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// Describes a curve by a falloff that renderers use: sets q.text and q.left to those of the falloff that leaves least.
/// Leaves them as they are where each leaves much more of the difference than the curve, where the right falloff is
/// none of those that are known, and where there are more than 1024 lights.
///   q: a curve against "d / range"
void name_falloff(const LightShares& shares, LightQuotient& q);

}  // namespace trueshade::oracle
