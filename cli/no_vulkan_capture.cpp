// Stands in for vulkan_capture.cpp where the headers of Vulkan or of glslang were absent when this was built.
#include "cli/vulkan_capture.h"
#include "core/error.h"

namespace trueshade {

DriverFrame drawn_by_vulkan_device(const std::string&, const Scene&, const Pipeline&) {
  throw Error(ErrorKind::no_gl_driver, "Vulkan", "this build has none",
              "build with libvulkan-dev and glslang-dev, or judge a capture with --gbuffer");
}

}  // namespace trueshade
