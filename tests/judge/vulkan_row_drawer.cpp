#include "gl/vulkan/vulkan_renderer.h"
#include "tests/judge/row_drawer.h"

namespace trueshade::testing {

RowDrawer lavapipe_drawer(const Scene& scene) {
  return [&scene](const Pipeline& pipeline, const oracle::StepSink& sink) {
    return oracle::drawn_by_vulkan(scene, pipeline, oracle::VulkanDriver::software, {sink, {}}).capture;
  };
}

}  // namespace trueshade::testing
