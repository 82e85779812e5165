#pragma once
#include <array>
#include <string>
#include <vector>

#include "gl/emit/glsl_terms.h"
#include "gl/lists/frame_list.h"
#include "gl/vulkan/device.h"

namespace trueshade::oracle {

/// A sampler of a pass, and its binding number.
struct BoundSampler {
  ShaderVariable variable;
  uint32_t binding = 0;
};

/// A pass made ready to draw: its pipeline, the members of its uniform blocks (vertex, fragment), and its samplers.
struct PassPipeline {
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  std::array<std::vector<BlockMember>, 2> blocks;
  std::vector<BoundSampler> samplers;
};

/// Makes a pass ready to draw. What it makes lives as long as the device.
PassPipeline make_pass_pipeline(VulkanDevice& device, const FrameList& list, const ListedPass& pass);

}  // namespace trueshade::oracle
