#pragma once
#include "gl/driver/context.h"

namespace trueshade::testing {

/// A driver of this machine, opened once; null where there is none, and then the test has said SKIPPED and why.
const oracle::GlContext* opened(oracle::GlDriver which);

/// llvmpipe of Mesa 22.3, whose bits the profile mesa-llvmpipe-22.3 promises; null, and SKIPPED said, where it is
/// another.
const oracle::GlContext* opened_mesa_22_3();

}  // namespace trueshade::testing
