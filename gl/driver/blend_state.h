#pragma once
#include "core/blend_state.h"

namespace trueshade::oracle {

/// Sets blending and the colour mask of all attachments, whatever was set before.
void set_blend_state(const BlendState& state);

}  // namespace trueshade::oracle
