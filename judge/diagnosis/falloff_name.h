#pragma once
#include "judge/diagnosis/light_quotient.h"
#include "judge/diagnosis/light_shares.h"

namespace trueshade::oracle {

/// Describes a curve by a falloff that renderers use, where one leaves hardly more of the difference than the curve.
///   q: a curve against "d / range"; then its `text` and `left` are the falloff's
void name_falloff(const LightShares& shares, LightQuotient& q);

}  // namespace trueshade::oracle
