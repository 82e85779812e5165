#pragma once
#include <string>

#include "scenes/builtin/pcg32.h"

namespace trueshade::testing {

/// A light's GLSL at random: scalars and vectors of the surface, the light and the view through all floating-point
/// functions of light programs, branches, loops, arrays, matrices and helper functions, in ranges where GLSL defines
/// each. What it adds is a colour up to about 4. A third have start(), finish() or reaches().
std::string random_light_text(Pcg32& random);

}  // namespace trueshade::testing
