#pragma once
#include <string>
#include <vector>

#include "gl/vulkan/device.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Functions that are shown the target while a frame is drawn.
struct VulkanDraw {
  StepSink after_light, after_object;  ///< as of GlDraw
};

struct VulkanFrame {
  Capture capture;
  int subpixel_bits = 0;           ///< VkPhysicalDeviceLimits::subPixelPrecisionBits
  double ms = 0;                   ///< wall time of the passes, pipelines made before
  std::vector<std::string> notes;  ///< where the device could not do what the pipeline says, and what was done instead
};

/// Draws a scene's frame, without the post chain, on a device that is opened for it, from the same list of draws that
/// `trueshade glsl --api vulkan` writes. Error(no_gl_driver) where there is no device, or it cannot draw the frame.
VulkanFrame drawn_by_vulkan(const Scene& scene, const Pipeline& pipeline, VulkanDriver driver,
                            const VulkanDraw& draw = {});

}  // namespace trueshade::oracle
