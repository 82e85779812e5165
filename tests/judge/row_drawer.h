#pragma once
#include <functional>
#include <string>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// Draws a frame of one scene; the sink, where there is one, sees the target after each light.
using RowDrawer = std::function<oracle::Capture(const Pipeline&, const oracle::StepSink&)>;

/// By a software device of Vulkan. Throws Error(no_gl_driver) where there is none, or this build has none. Borrows the
/// scene.
RowDrawer lavapipe_drawer(const Scene& scene);

}  // namespace trueshade::testing
