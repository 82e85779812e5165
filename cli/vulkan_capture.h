#pragma once
#include <optional>
#include <string>

#include "cli/driver_capture.h"

namespace trueshade {

/// As drawn_by_driver(), by a driver of Vulkan: `vulkan` (the first device), `lavapipe` (a CPU's) or `swiftshader`.
/// Throws Error(no_gl_driver) where there is none, and always in a build without Vulkan.
DriverFrame drawn_by_vulkan_device(const std::string& driver, const Scene& scene, const Pipeline& pipeline);

/// Whether `--driver` names Vulkan.
inline bool names_vulkan(const std::optional<std::string>& driver) {
  return driver && (*driver == "vulkan" || *driver == "lavapipe" || *driver == "swiftshader");
}

/// By whichever `--driver` names; by OpenGL's default without it.
inline DriverFrame drawn_by(const std::optional<std::string>& driver, const Scene& scene, const Pipeline& pipeline) {
  return names_vulkan(driver) ? drawn_by_vulkan_device(*driver, scene, pipeline)
                              : drawn_by_driver(driver.value_or("default"), scene, pipeline);
}

}  // namespace trueshade
