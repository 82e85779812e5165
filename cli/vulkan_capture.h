#pragma once
#include "cli/driver_capture.h"

namespace trueshade {

/// As drawn_by_driver(), by Vulkan: by a CPU's device (`--driver lavapipe`), or by the first that there is. Throws
/// Error(no_gl_driver) where there is none, and always in a build without Vulkan.
DriverFrame drawn_by_vulkan_device(bool software, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
