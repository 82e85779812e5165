#pragma once
#include <array>

#include "core/blend_state.h"
#include "core/format.h"
#include "core/numeric_profile.h"

namespace trueshade::oracle {

using Rgba = std::array<float, 4>;

/// One fragment blended into one pixel, the slow way: docs/arithmetic.md sections 10 and 11, a channel at a time, with
/// arithmetic of its own. `stored` and the result are what the format holds: codes 0..255, or the floats.
Rgba blended_pixel(const BlendState& state, NumericProfile profile, Format format, HalfRound half_round,
                   const Rgba& source, const Rgba& stored);

/// Whether this CPU estimates 1/sqrt as the AMD EPYC did that the profile's sRGB codes were recorded on: the oracle
/// asks the CPU, as llvmpipe does.
bool estimates_as_recorded();

}  // namespace trueshade::oracle
