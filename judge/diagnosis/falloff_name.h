#pragma once
#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// Describes a measured curve by the well-known falloff that comes nearest to it: sets q.text and q.left to that
/// falloff's. Leaves both as they are where every known falloff leaves much more of the difference than the curve does,
/// where the right falloff is none of those known, and where there are more than 1024 lights.
///   q: a curve against "d / range"
void name_falloff(const LightShares& shares, LightQuotient& q);

}  // namespace trueshade::oracle
