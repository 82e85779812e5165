#pragma once
#include "gl/driver/context.h"

namespace trueshade::testing {

/// A driver of this machine, opened once; null where there is none, and then the test has said SKIPPED and why.
const oracle::GlContext* opened(oracle::GlDriver which);

/// Whether this is an llvmpipe that the profile mesa-llvmpipe-22.3 explains in targets of 8 bits and floats: that of
/// Mesa 22.3, or of 25.0, of which a probe tells the same (docs/data/drivers.md).
bool is_of_known_profile(const oracle::GlContext& context);

/// llvmpipe of Mesa 22.3, whose bits the profile mesa-llvmpipe-22.3 promises; null, and SKIPPED said, where it is
/// another.
const oracle::GlContext* opened_mesa_22_3();

}  // namespace trueshade::testing
